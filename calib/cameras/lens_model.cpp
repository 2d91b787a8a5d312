// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/lens_model.h"

#include <numeric>

namespace alidade {

std::string_view name_of(LensModel lens) {
  switch (lens) {
    case LensModel::Radial:
      return "radial";
    case LensModel::Brown:
      return "brown";
    case LensModel::Rational:
      return "rational";
    case LensModel::Fisheye:
      return "fisheye";
  }
  return "";
}

std::vector<int> free_intrinsics(LensModel lens) {
  const std::size_t count = lens == LensModel::Brown ? 9 : lens == LensModel::Rational ? 12 : 8;
  std::vector<int> places(count);
  std::iota(places.begin(), places.end(), 0);
  return places;
}

Camera start_camera(LensModel lens, int width, int height, double focal_px) {
  Camera camera{width, height, focal_px, focal_px, 0.5 * (width - 1), 0.5 * (height - 1), {}, 0};
  if (lens == LensModel::Fisheye) camera.distortion = Fisheye{};
  return camera;
}

}  // namespace alidade
