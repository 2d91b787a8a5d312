// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "capture/camera_device.h"

// Of Aravis and GLib, whose headers stay in the sources.
using ArvCamera = struct _ArvCamera;
using ArvDevice = struct _ArvDevice;
using ArvStream = struct _ArvStream;
using GError = struct _GError;

namespace alidade {

struct ReleaseGObject {
  void operator()(void* object) const;
};

/// A reference to an object of GLib's kind, given back at the end.
template <typename T>
using GObjectPointer = std::unique_ptr<T, ReleaseGObject>;

/// Where a call into Aravis leaves its error: `arv_...(camera, AravisFault().out())`.
class AravisFault {
 public:
  AravisFault() = default;
  AravisFault(const AravisFault&) = delete;
  AravisFault& operator=(const AravisFault&) = delete;
  ~AravisFault();

  GError** out();  ///< forgets an error before
  bool happened() const { return error_ != nullptr; }
  std::string text() const;
  CameraTrouble trouble() const;

  /// Throws a CameraError of this fault; nothing where none happened.
  void check(const std::string& source, const std::string& operation) const;

 private:
  GError* error_ = nullptr;
};

/// Keeps Aravis from writing to standard error, unless ARV_DEBUG in the environment asks for it.
void silence_aravis();

}  // namespace alidade
