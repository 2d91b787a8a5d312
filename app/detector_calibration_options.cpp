// SPDX-License-Identifier: Apache-2.0
#include "app/detector_calibration_options.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {

void validate(const DetectorCalibrationChoice& choice) {
  validate(choice.solver);
  validate(choice.windows);
  if (!(choice.reference_sigma_m > 0 && std::isfinite(choice.reference_sigma_m))) {
    throw std::invalid_argument(fmt::format("reference_sigma_m must be > 0 m, got {}", choice.reference_sigma_m));
  }
}

void bind(OptionFields& fields, DetectorCalibrationChoice& choice) {
  DetectorCalibrationOptions& o = choice.solver;
  fields.add("held_station", o.held_station, "",
             "the station whose pose stands and gives the world its frame; empty: the first detector's");
  fields.add("knot_interval_s", o.knot_interval_s, "s", "between the states of the estimated motion");
  fields.add("density.acceleration", o.density.acceleration, "m^2/s^3", "how abruptly the body is pushed");
  fields.add("density.turn", o.density.turn, "rad^2/s^3", "how abruptly it is turned");
  fields.add("longest_gap_s", o.longest_gap_s, "s", "without readings: the motion starts anew after it");
  fields.add("loss_sigmas", o.loss_sigmas, "", "beyond which a reading hardly counts");
  fields.add("max_iterations", o.max_iterations, "", "of the stations; ten to fifty are usual");
  fields.add("marker_sigma_m", o.marker_sigma_m, "m", "how well the body's markers are known; 0: they stand");
  fields.add("body_size_sigma", o.body_size_sigma, "", "how well the body's size is known, as a part of it");
  SweepTerms& t = o.term_sigma;
  fields.add("term_sigma.phase", t.phase, "rad", "how well laser sweeps' factory terms are known; 0: they stand");
  fields.add("term_sigma.tilt", t.tilt, "rad", "as phase");
  fields.add("term_sigma.curve", t.curve, "rad", "as phase");
  fields.add("term_sigma.gibmag", t.gibmag, "rad", "as phase");
  fields.add("term_sigma.gibphase", t.gibphase, "rad", "as phase");
  fields.add("term_sigma.ogeemag", t.ogeemag, "rad", "as phase");
  fields.add("term_sigma.ogeephase", t.ogeephase, "rad", "as phase");
  fields.add("reference_sigma_m", choice.reference_sigma_m, "m", "of each coordinate of --reference");
  fields.add("rotor_times", choice.rotor_times, "", "laser sweeps that were stamped late get their rotors' times");
  fields.add("window.length_s", choice.windows.window_s, "s", "of the windows that verification fits one by one");
  fields.add("window.least_readings", choice.windows.least_readings, "", "a window with fewer is passed over");
  fields.add("window.explained_sigmas", choice.windows.explained_sigmas, "", "a reading that near is explained");
  fields.add("window.explained_share", choice.windows.explained_share, "", "of a window's readings, to explain it");
  fields.add_check([&choice] { validate(choice); });
}

}  // namespace alidade
