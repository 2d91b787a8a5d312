// SPDX-License-Identifier: Apache-2.0
#include "app/targets/simulation_options.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

// What is wrong with a file of options; "(nothing thrown)" where nothing is.
std::string fault_of(const std::string& yaml) {
  const test::TemporaryDirectory folder;
  TargetSimulationOptions options;
  OptionFields fields;
  bind(fields, options);
  const auto file = folder.write("options.yaml", yaml);
  return test::message_of(folder.path(), [&] {
    fields.read(file);
    fields.validate("options.yaml");
  });
}

TEST(TargetSimulationOptions, TakeTheDelaysAsText) {
  TargetSimulationOptions options;
  EXPECT_EQ(scene_of(options).delays_s, (std::vector<double>{0.0, 0.1, 0.2}));
  options.delays_s = "0.25";
  options.scene.targets = 7;
  EXPECT_EQ(scene_of(options).delays_s, (std::vector<double>{0.25}));
  EXPECT_EQ(scene_of(options).targets, 7);
}

TEST(TargetSimulationOptions, GiveEveryTargetOfAVideoADot) {
  TargetSimulationOptions options;
  options.scene.targets = 3;
  options.scene.receivers = 5;
  options.dot_size_px = 3.5;
  const SkySceneOptions sky = sky_of(options);
  EXPECT_EQ(sky.receivers, 5);
  ASSERT_EQ(sky.dots.size(), 3u);
  EXPECT_EQ(sky.dots[2].size_px, 3.5);
  EXPECT_NE(sky.dots[0].is_dark, sky.dots[1].is_dark);
}

TEST(TargetSimulationOptions, AreReadBackAsTheyAreWritten) {
  TargetSimulationOptions options;
  OptionFields fields;
  bind(fields, options);
  options.delays_s = "0,0.5";
  options.scene.scan_law = ScanLaw::Cued;
  options.scene.detection_probability = 0.75;
  const test::TemporaryDirectory folder;
  TargetSimulationOptions again;
  OptionFields fields_again;
  bind(fields_again, again);
  fields_again.read(folder.write("options.yaml", fields.to_yaml()));
  EXPECT_EQ(again.delays_s, "0,0.5");
  EXPECT_EQ(again.scene.scan_law, ScanLaw::Cued);
  EXPECT_EQ(again.scene.detection_probability, 0.75);
  EXPECT_EQ(fields_again.to_yaml(), fields.to_yaml());
}

TEST(TargetSimulationOptions, AreRefusedWhereTheyAreImpossible) {
  EXPECT_EQ(fault_of("targets: 4\n"), "(nothing thrown)");
  EXPECT_EQ(fault_of("truth_rate_hz: 0\n"), "options.yaml: truth_rate_hz must be > 0 Hz, got 0");
  EXPECT_EQ(fault_of("delays_s: \"0,x\"\n"), "options.yaml: delays_s must be numbers with commas between, got 'x'");
  EXPECT_NE(fault_of("targets: 0\n").find("targets must be"), std::string::npos);
  EXPECT_NE(fault_of("videos: true\nvideo: {fps_hz: 0}\n").find("fps_hz must be"), std::string::npos);
}

}  // namespace
}  // namespace alidade
