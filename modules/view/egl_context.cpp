// SPDX-License-Identifier: Apache-2.0
#include "view/egl_context.h"

#include <utility>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

// Debian's GLEW knows GLX only: glewInit() loads every entry point and then fails in its GLX part where no X display is
// current. The program exports this function, so that VTK calls it instead and accepts an EGL context; every other
// result passes through. The view target's link option exports it, and egl_context's callers link it in.
extern "C" __attribute__((visibility("default"))) unsigned glewInit() {
  constexpr unsigned kNoDevice = 1, kNoGlxDisplay = 4, kOk = 0;
  const auto glew = reinterpret_cast<unsigned (*)()>(dlsym(RTLD_NEXT, "glewInit"));
  const unsigned result = glew != nullptr ? glew() : kNoDevice;
  return result == kNoGlxDisplay ? kOk : result;
}

namespace alidade {
namespace {

EGLDisplay surfaceless_display() {
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (get_display == nullptr) return EGL_NO_DISPLAY;
  const EGLDisplay display = get_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) return EGL_NO_DISPLAY;
  return display;
}

EGLContext create_context(EGLDisplay display) {
  constexpr EGLint kConfig[] = {EGL_SURFACE_TYPE,
                                EGL_PBUFFER_BIT,
                                EGL_RENDERABLE_TYPE,
                                EGL_OPENGL_BIT,
                                EGL_RED_SIZE,
                                8,
                                EGL_GREEN_SIZE,
                                8,
                                EGL_BLUE_SIZE,
                                8,
                                EGL_DEPTH_SIZE,
                                24,
                                EGL_NONE};
  constexpr EGLint kContext[] = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, kConfig, &config, 1, &count) == EGL_FALSE || count == 0) return EGL_NO_CONTEXT;
  return eglCreateContext(display, config, EGL_NO_CONTEXT, kContext);
}

}  // namespace

std::optional<EglContext> EglContext::open() {
  if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return std::nullopt;
  const EGLDisplay display = surfaceless_display();
  if (display == EGL_NO_DISPLAY) return std::nullopt;
  const EGLContext context = create_context(display);
  if (context == EGL_NO_CONTEXT) return std::nullopt;
  EglContext opened(display, context);
  if (!opened.make_current()) return std::nullopt;  // a driver without EGL_KHR_surfaceless_context
  opened.release();
  return opened;
}

EglContext::EglContext(EglContext&& other) noexcept
    : display_(other.display_), context_(std::exchange(other.context_, nullptr)) {}

EglContext::~EglContext() {
  if (context_ != nullptr) eglDestroyContext(display_, context_);
}

bool EglContext::make_current() const {
  // The bound API is per thread, and OpenGL ES unless said.
  return eglBindAPI(EGL_OPENGL_API) == EGL_TRUE &&
         eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
}

void EglContext::release() const {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace alidade
