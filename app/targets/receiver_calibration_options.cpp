// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_options.h"

namespace alidade {
namespace {

void bind(OptionFields& fields, ResectionOptions& o) {
  fields.add("resection.search_s", o.search_s, "s", "how far a clock's offset may be from the given one");
  fields.add("resection.keep_pose", o.keep_pose, "", "start from the given pose and clock: nothing is searched for");
  fields.add("resection.find_place", o.find_place, "", "where receivers stand; off: as they are said to");
  fields.add("resection.find_turn", o.find_turn, "", "where they look; off: as they are said to");
  fields.add("resection.find_rate", o.find_rate, "", "how fast clocks run, beside their offset");
  fields.add("resection.find_readout", o.find_readout, "", "rolling shutters");
  fields.add("resection.find_focal", o.find_focal, "", "a scale of the focal lengths");
  fields.add("resection.loss_sigmas", o.loss_sigmas, "", "beyond which a reading hardly counts");
  fields.add("resection.block_s", o.block_s, "s", "within it readings are off together: covariances count by it");
  fields.add("resection.least_readings", o.least_readings, "", "a receiver with fewer on the path is left as given");
}

void bind(OptionFields& fields, ReceiverCheckOptions& o) {
  fields.add("check.least_place_m", o.least_place_m, "m", "a place off by less is no fault");
  fields.add("check.least_focal", o.least_focal, "", "a focal length off by a smaller share is none");
  fields.add("check.least_uneven_s", o.least_uneven_s, "s", "a clock off by less at worst is none");
  fields.add("check.sigmas", o.sigmas, "", "standard deviations by which faults must stand out");
}

void bind(OptionFields& fields, SplineBundleOptions& o) {
  fields.add("bundle.knot_interval_s", o.knot_interval_s, "s", "without a known path: between the knots of its spline");
  fields.add("bundle.readings_per_s", o.readings_per_s, "1/s", "of each receiver; the others are passed over");
  fields.add("bundle.jerk_m_s3", o.jerk_m_s3, "m/s3", "of each coordinate of the path, typically");
  fields.add("bundle.place_sigma_m", o.place_sigma_m, "m", "how far places may be off; 0: they stand");
  fields.add("bundle.turn_sigma_rad", o.turn_sigma_rad, "rad", "how far directions may be off; 0: they stand");
  fields.add("bundle.offset_sigma_s", o.offset_sigma_s, "s", "how far clocks may be off; 0: they stand");
  fields.add("bundle.rate_sigma", o.rate_sigma, "", "how far clocks' rates may be off; 0: they stand");
  fields.add("bundle.readout_sigma_s", o.readout_sigma_s, "s", "how far rolling shutters may be off; 0: they stand");
  fields.add("bundle.focal_sigma", o.focal_sigma, "", "how far focal lengths may be off, as a part; 0: they stand");
  fields.add("bundle.loss_sigmas", o.loss_sigmas, "", "beyond which a reading hardly counts");
  fields.add("bundle.rounds", o.rounds, "", "of new weights and knots");
}

}  // namespace

void validate(const ReceiverCalibrationChoice& choice) {
  validate(choice.resection);
  validate(choice.checks);
  validate(choice.bundle);
}

void bind(OptionFields& fields, ReceiverCalibrationChoice& choice) {
  bind(fields, choice.resection);
  bind(fields, choice.checks);
  bind(fields, choice.bundle);
  fields.add("time_receiver", choice.time_receiver, "",
             "without a known path: name of the receiver whose clock is the common one; empty: the first camera");
  fields.add_check([&choice] { validate(choice); });
}

}  // namespace alidade
