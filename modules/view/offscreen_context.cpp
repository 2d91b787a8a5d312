// SPDX-License-Identifier: Apache-2.0
#include "view/offscreen_context.h"

#include <optional>
#include <utility>

#include <vtkCallbackCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

#include "core/errors.h"
#include "view/egl_context.h"
#include "view/x_display.h"

namespace alidade {

// The context outlives the window, whose last act is to free its textures: members die in reverse order.
struct OffscreenContext::Surface {
  DrawingRoute route = DrawingRoute::Egl;
  std::optional<EglContext> egl;
  std::optional<XDisplay> display;
  vtkSmartPointer<vtkRenderWindow> window;

  void make_current() {
    if (egl) {
      egl->make_current();
    } else {
      window->MakeCurrent();
    }
  }

  void release() {
    if (egl) {
      egl->release();
    } else {
      window->ReleaseCurrent();
    }
  }
};

namespace {

vtkSmartPointer<vtkRenderWindow> make_egl_window(EglContext& egl) {
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->SetReadyForRendering(true);
  window->SetIsCurrent(true);
  window->SetSupportsOpenGL(1);
  window->SetIsDirect(1);
  window->SetMapped(1);
  vtkNew<vtkCallbackCommand> make_current;
  make_current->SetClientData(&egl);
  make_current->SetCallback(
      [](vtkObject*, unsigned long, void* context, void*) { static_cast<EglContext*>(context)->make_current(); });
  window->AddObserver(vtkCommand::WindowMakeCurrentEvent, make_current);
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  egl.make_current();
  window->OpenGLInit();  // not OpenGLInitContext, which leaves the picture black
  return window;
}

vtkSmartPointer<vtkRenderWindow> make_x_window(const XDisplay& display) {
  auto window = vtkSmartPointer<vtkRenderWindow>::New();  // VTK's factory makes the X kind
  window->SetDisplayId(display.handle());
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  return window;
}

}  // namespace

OffscreenContext::OffscreenContext(std::span<const DrawingRoute> routes) : surface_(std::make_unique<Surface>()) {
  vtkObject::GlobalWarningDisplayOff();  // modules do not print
  for (const DrawingRoute route : routes) {
    surface_->route = route;
    if (route == DrawingRoute::Egl) {
      if (auto egl = EglContext::open()) surface_->egl.emplace(std::move(*egl));
    } else if (auto display =
                   route == DrawingRoute::UsersDisplay ? XDisplay::open_users() : XDisplay::start_private()) {
      surface_->display.emplace(std::move(*display));
    }
    if (surface_->egl) surface_->window = make_egl_window(*surface_->egl);
    if (surface_->display) surface_->window = make_x_window(*surface_->display);
    if (!surface_->window) continue;
    surface_->release();
    return;
  }
  throw DeviceError("drawing off-screen", "open", "neither EGL nor an X server with OpenGL is there",
                    "install libegl1, libegl-mesa0 and libgl1-mesa-dri, or xvfb");
}

OffscreenContext::~OffscreenContext() {
  surface_->make_current();
  surface_->window->Finalize();
  surface_->window = nullptr;
  if (surface_->egl) surface_->egl->release();
}

DrawingRoute OffscreenContext::route() const {
  return surface_->route;
}

vtkRenderWindow& OffscreenContext::window() {
  return *surface_->window;
}

OffscreenContext::Current::Current(OffscreenContext& context) : context_(context) {
  context_.surface_->make_current();
}

OffscreenContext::Current::~Current() {
  context_.surface_->release();
}

}  // namespace alidade
