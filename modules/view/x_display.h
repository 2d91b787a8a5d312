// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace alidade {

/// A connection to an X server that can draw with OpenGL, and the server itself where it is ours.
class XDisplay {
 public:
  /// The server of $DISPLAY; empty where there is none, it does not answer, or it has no GLX.
  static std::optional<XDisplay> open_users();

  /// A private Xvfb on the first free display, which ends with this object (or with the thread that started it).
  /// Empty where Xvfb is not installed or does not come up within ten seconds.
  static std::optional<XDisplay> start_private();

  XDisplay(XDisplay&& other) noexcept;
  XDisplay& operator=(XDisplay&&) = delete;
  ~XDisplay();

  /// Xlib's Display*.
  void* handle() const { return display_; }

 private:
  XDisplay(void* display, int server) : display_(display), server_(server) {}
  static void* connect(const char* name);

  void* display_;
  int server_;  // process id of our Xvfb, or -1
};

}  // namespace alidade
