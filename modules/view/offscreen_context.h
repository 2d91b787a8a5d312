// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>

class vtkRenderWindow;

namespace alidade {

/// Where OpenGL can draw without a window on the user's screen.
enum class DrawingRoute {
  Egl,            ///< without any X server
  UsersDisplay,   ///< the X server of $DISPLAY
  PrivateServer,  ///< an Xvfb of our own
};

/// The order in which they are tried.
inline constexpr DrawingRoute kDrawingRoutes[] = {DrawingRoute::Egl, DrawingRoute::UsersDisplay,
                                                  DrawingRoute::PrivateServer};

/// A VTK window that nobody sees, with its own OpenGL context, so that several can live side by side. It may be used
/// from any one thread at a time, between Current objects.
class OffscreenContext {
 public:
  /// The first of `routes` that this machine can go. Throws DeviceError, with what to install, where it can go none.
  explicit OffscreenContext(std::span<const DrawingRoute> routes = kDrawingRoutes);
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  DrawingRoute route() const;
  vtkRenderWindow& window();

  /// While it lives, the calling thread draws in the context.
  class Current {
   public:
    explicit Current(OffscreenContext& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    OffscreenContext& context_;
  };

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

}  // namespace alidade
