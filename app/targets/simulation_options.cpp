// SPDX-License-Identifier: Apache-2.0
#include "app/targets/simulation_options.h"

#include <stdexcept>

#include <fmt/format.h>

#include "app/targets/number_list.h"

namespace alidade {
void bind(OptionFields& fields, TargetSimulationOptions& options) {
  TargetSceneOptions& scene = options.scene;
  fields.add("targets", scene.targets, "", "number of flying objects");
  fields.add("receivers", scene.receivers, "", "around them; three see them at right angles");
  fields.add("periods", scene.periods, "", "number of scans");
  fields.add("period_s", scene.period_s, "s", "from scan to scan");
  fields.add_choice("scan_law", scene.scan_law,
                    {{"delays", ScanLaw::Delays}, {"rotating", ScanLaw::Rotating}, {"cued", ScanLaw::Cued}},
                    "when a receiver looks where: all at once after its delay; a fan beam that turns; steered by the "
                    "first receiver");
  fields.add("delays_s", options.delays_s, "s", "of the receivers' scans, with commas between");
  fields.add("slew_rad_s", scene.slew_rad_s, "rad/s", "how fast steered receivers turn");
  fields.add("least_range_m", scene.least_range_m, "m", "of the receivers from the targets' middle");
  fields.add("greatest_range_m", scene.greatest_range_m, "m", "likewise");
  fields.add("elevation_rad", scene.elevation_rad, "rad", "at which the receivers look up at the targets");
  fields.add("sigma_m", scene.sigma_m, "m",
             "bearings err by so much at the receivers' range, across the line of sight");
  fields.add("spread_m", scene.spread_m, "m", "side of the cube in which the targets set off");
  fields.add("least_distance_m", scene.least_distance_m, "m", "between any two of them there");
  fields.add("velocity_sigma_m_s", scene.velocity_sigma_m_s, "m/s", "of each coordinate of their common velocity");
  fields.add("top_speed_m_s", scene.top_speed_m_s, "m/s", "of that velocity");
  fields.add("scatter_m_s", scene.scatter_m_s, "m/s", "of each one's velocity about it");
  fields.add("acceleration_m_s2", scene.acceleration_m_s2, "m/s2", "of each coordinate of each one's");
  fields.add("detection_probability", scene.detection_probability, "", "of each target in each scan");
  fields.add("false_bearings", scene.false_bearings, "", "mean number per scan and receiver");
  fields.add("cone_rad", scene.cone_rad, "rad", "full angle of the cone in which they lie");
  fields.add("temperature_sigma_k", scene.temperature_sigma_k, "K",
             "error of the temperatures that all receivers but the first read; 0: none is read");
  fields.add("comes_and_goes", scene.comes_and_goes, "", "some appear later or leave earlier");
  fields.add("truth_rate_hz", options.truth_rate_hz, "Hz", "rows of the true paths per second and target");
  fields.add("videos", options.has_videos, "", "what cameras film of them before a sky, instead of bearings");
  fields.add("video.duration_s", options.sky.duration_s, "s", "of the videos");
  fields.add("video.width", options.sky.width, "px", "of the images");
  fields.add("video.height", options.sky.height, "px", "of the images");
  fields.add("video.focal_px", options.sky.focal_px, "px", "focal length");
  fields.add("video.fps_hz", options.sky.fps_hz, "Hz", "of the first camera; each further one is 1 % slower");
  fields.add("video.range_m", options.sky.range_m, "m", "of the cameras from the middle of the targets' space");
  fields.add("video.dot_size_px", options.dot_size_px, "px", "diameter of a target's image");
  fields.add("video.dot_snr", options.dot_snr, "", "its contrast over the noise of a pixel");
  fields.add("video.shake_px", options.sky.look.shake_px, "px", "root mean square of the picture's swaying by wind");
  fields.add_check([&options] {
    if (!(options.truth_rate_hz > 0.0)) {
      throw std::invalid_argument(fmt::format("truth_rate_hz must be > 0 Hz, got {}", options.truth_rate_hz));
    }
    options.has_videos ? validate(sky_of(options)) : validate(scene_of(options));
  });
}

TargetSceneOptions scene_of(const TargetSimulationOptions& options) {
  TargetSceneOptions scene = options.scene;
  scene.delays_s = parse_numbers("delays_s", options.delays_s);
  return scene;
}

SkySceneOptions sky_of(const TargetSimulationOptions& options) {
  SkySceneOptions sky = options.sky;
  sky.receivers = options.scene.receivers;
  sky.dots.clear();
  for (int i = 0; i < options.scene.targets; ++i)
    sky.dots.push_back({options.dot_size_px, options.dot_snr, i % 2 == 0});
  return sky;
}

}  // namespace alidade
