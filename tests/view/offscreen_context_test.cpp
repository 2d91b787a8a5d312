// SPDX-License-Identifier: Apache-2.0
#include "view/offscreen_context.h"

#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "core/errors.h"
#include "view/renderer.h"

namespace alidade {
namespace {

// Sets an environment variable for one test.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    value != nullptr ? setenv(name, value, 1) : unsetenv(name);
  }
  ~Environment() { old_.empty() ? unsetenv(name_) : setenv(name_, old_.c_str(), 1); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::string old_;
};

cv::Mat picture_of(Renderer& renderer) {
  Scene scene;
  scene.cameras.resize(3);
  scene.cameras[1].T_world_camera.translation().x() = 0.3;
  scene.cameras[1].style = PyramidStyle::Solid;
  scene.cameras[2].T_world_camera.translation().y() = 0.3;
  renderer.show(scene);
  return renderer.render(frame_scene(scene), {160, 120});
}

TEST(OffscreenContext, DrawsWithoutAnyDisplay) {
  const Environment no_display("DISPLAY", nullptr);
  Renderer renderer;
  const cv::Mat picture = picture_of(renderer);
  EXPECT_GT(cv::norm(picture, cv::Mat(picture.size(), CV_8UC3, cv::Scalar(252, 250, 250)), cv::NORM_INF), 100);
}

TEST(OffscreenContext, TakesTheFirstRouteThatGoes) {
  const Environment stale("DISPLAY", ":987");
  const DrawingRoute routes[] = {DrawingRoute::UsersDisplay, DrawingRoute::Egl};
  const OffscreenContext context(routes);
  EXPECT_EQ(context.route(), DrawingRoute::Egl);
}

TEST(OffscreenContext, APrivateServerDrawsTheSamePicture) {
  const DrawingRoute egl[] = {DrawingRoute::Egl}, server[] = {DrawingRoute::PrivateServer};
  Renderer without_x(egl);
  try {
    Renderer with_x(server);
    EXPECT_LE(cv::norm(picture_of(without_x), picture_of(with_x), cv::NORM_INF), 2);
  } catch (const DeviceError&) {
    GTEST_SKIP() << "Xvfb is not installed";
  }
}

TEST(OffscreenContext, SaysWhatToInstallWhereNothingCanDraw) {
  const Environment stale("DISPLAY", ":987"), nowhere("PATH", "/nonexistent");
  const DrawingRoute routes[] = {DrawingRoute::UsersDisplay, DrawingRoute::PrivateServer};
  try {
    const OffscreenContext context(routes);
    FAIL() << "no error";
  } catch (const DeviceError& error) {
    EXPECT_STREQ(error.what(),
                 "drawing off-screen: open: neither EGL nor an X server with OpenGL is there; install libegl1, "
                 "libegl-mesa0 and libgl1-mesa-dri, or xvfb");
  }
}

TEST(OffscreenContext, SeveralLiveSideBySideAndMoveBetweenThreads) {
  Renderer first;
  const cv::Mat expected = picture_of(first);
  Renderer second;
  cv::Mat from_thread, again;
  std::thread([&] { from_thread = picture_of(second); }).join();
  std::thread([&] { again = picture_of(first); }).join();
  EXPECT_EQ(cv::norm(from_thread, expected, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(again, expected, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(picture_of(first), expected, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace alidade
