// SPDX-License-Identifier: Apache-2.0
#include "app/camera_calibration_options.h"

namespace alidade {

CameraCalibrationOptions effective_options(const CameraCalibrationChoice& choice) {
  CameraCalibrationOptions options = choice.solver;
  switch (choice.lens) {
    case LensChoice::Auto:
      break;
    case LensChoice::Radial:
      options.lens = LensModel::Radial;
      break;
    case LensChoice::Brown:
      options.lens = LensModel::Brown;
      break;
    case LensChoice::Rational:
      options.lens = LensModel::Rational;
      break;
    case LensChoice::Fisheye:
      options.lens = LensModel::Fisheye;
      break;
  }
  if (choice.corners != CornerChoice::Auto) options.free_corners = choice.corners == CornerChoice::Found;
  return options;
}

void bind(OptionFields& fields, CameraCalibrationChoice& choice) {
  CameraCalibrationOptions& o = choice.solver;
  fields.add_choice(
      "lens", choice.lens,
      {{"auto", LensChoice::Auto},
       {"radial", LensChoice::Radial},
       {"brown", LensChoice::Brown},
       {"rational", LensChoice::Rational},
       {"fisheye", LensChoice::Fisheye}},
      "auto: by the error on images left out; radial: k1 k2 p1 p2; brown: and k3; rational: and k4 k5 k6");
  fields.add_choice("corners", choice.corners,
                    {{"auto", CornerChoice::Auto}, {"printed", CornerChoice::Printed}, {"found", CornerChoice::Found}},
                    "of the board: printed where they should be, found from the images, or what errs less on others");
  fields.add("folds", o.folds, "", "of the images, to judge a lens by images that it was not fitted to");
  fields.add("simpler_within", o.simpler_within, "", "times the least error left out: a simpler lens is taken");
  fields.add("repeated_view_px", o.repeated_view_px, "px", "an image that differs less from another is left out");
  fields.add("least_tilt_deg", o.least_tilt_deg, "deg", "between two boards; with less there is no result");
  fields.add("worst_focal_sigma", o.worst_focal_sigma, "", "standard deviation of fx, a share of it: no result beyond");
  fields.add("weigh_views", o.fit.weigh_views, "", "an image whose corners scatter more counts less");
  fields.add("least_sigma_px", o.fit.least_sigma_px, "px", "no corner is trusted more than this");
  fields.add("outlier_sigmas", o.fit.outlier_sigmas, "", "corners beyond it are cut");
  fields.add_check([&o] { validate(o); });
}

}  // namespace alidade
