// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace alidade {

/// An OpenGL 3.2 core context without any surface or X server (EGL_PLATFORM_SURFACELESS_MESA), on the graphics card
/// where there is one and by software otherwise. Current on no thread until make_current.
class EglContext {
 public:
  /// Empty where this machine's EGL cannot do it.
  static std::optional<EglContext> open();

  EglContext(EglContext&& other) noexcept;
  EglContext& operator=(EglContext&&) = delete;
  ~EglContext();

  /// Makes it the calling thread's context; it must not be current on another thread. False if EGL refuses.
  bool make_current() const;
  /// Leaves the calling thread without a context.
  void release() const;

 private:
  EglContext(void* display, void* context) : display_(display), context_(context) {}

  void* display_;  // EGLDisplay, one per process and never terminated: other contexts may use it
  void* context_;  // EGLContext
};

}  // namespace alidade
