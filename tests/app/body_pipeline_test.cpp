// SPDX-License-Identifier: Apache-2.0
#include "app/body_pipeline.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "datasets/body_scene.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

BodySceneOptions scene_options(int bodies) {
  BodySceneOptions options;
  options.frames = 40;
  options.bodies = bodies;
  return options;
}

// What the pipeline makes of a simulated scene; `live` counts what it tells at once.
BodyRun run_of(const BodyTrackOptions& options, int bodies, int& live) {
  const test::TemporaryDirectory folder;
  const ResultDirectory directory(folder / "out", "track body");
  BodyScene scene(scene_options(bodies));
  BodyRecord record(directory, scene.detectors(), scene.bodies(), detail_of(options));
  BodyPipeline pipeline(scene.detectors(), scene.bodies(), options, record,
                        [&](const std::string& body, const BodyEstimate&) {
                          EXPECT_TRUE(body.starts_with("body"));
                          ++live;
                        });
  while (const auto frame = scene.next()) {
    for (const LineReading& reading : frame->readings) pipeline.add(reading);
  }
  pipeline.finish();
  return record.commit();
}

TEST(BodyPipeline, MakesOneBatchOfEachFrameAndTellsEveryBodyOfIt) {
  for (const double lag_s : {0.0, 0.02, 10.0}) {
    BodyTrackOptions options;
    options.lag_s = lag_s;
    int live = 0;
    const BodyRun run = run_of(options, 2, live);
    EXPECT_EQ(live, 80);
    EXPECT_EQ(run.batches, 40);
    for (const BodyTally& tally : run.tallies) {
      EXPECT_EQ(tally.batches(), 40) << lag_s;
      EXPECT_EQ(tally.tracked, 40) << lag_s;
    }
  }
}

TEST(BodyPipeline, FollowsWithThePapersMethod) {
  BodyTrackOptions options;
  options.method = BodyMethod::Paper;
  int live = 0;
  const BodyRun run = run_of(options, 1, live);
  EXPECT_EQ(run.detail, PoseDetail::Pose);
  EXPECT_EQ(run.tallies[0].tracked, 40);
  EXPECT_GT(run.tallies[0].explained, 0.99 * static_cast<double>(run.tallies[0].readings));
}

TEST(BodyPipeline, RefusesAMarkerOfNoBody) {
  const test::TemporaryDirectory folder;
  const ResultDirectory directory(folder / "out", "track body");
  const BodyScene scene(scene_options(1));
  BodyRecord record(directory, scene.detectors(), scene.bodies());
  BodyPipeline pipeline(scene.detectors(), scene.bodies(), {}, record, {});
  pipeline.add({Timestamp(), 0, 77, 0.1, 0.0});
  EXPECT_THROW(pipeline.finish(), std::invalid_argument);
}

TEST(BodyTrackOptions, NameFieldValueAndBound) {
  const auto message = [](auto change) -> std::string {
    BodyTrackOptions options;
    change(options);
    try {
      validate(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "fine";
  };
  EXPECT_EQ(message([](auto&) {}), "fine");
  EXPECT_EQ(message([](auto& o) { o.batch_s = 0; }), "batch_s must be > 0 s and <= 1 s, got 0");
  EXPECT_EQ(message([](auto& o) { o.lag_s = -1; }), "lag_s must be 0..60 s, got -1");
  EXPECT_NE(message([](auto& o) { o.ours.update.gate_chi2 = 0; }).find("gate_chi2"), std::string::npos);
}

TEST(BodyTrackOptions, AreWrittenWithTheirUnits) {
  OptionFields fields;
  BodyTrackOptions options;
  bind(fields, options);
  EXPECT_NE(fields.to_yaml().find("lag_s: 0.5  # [s]"), std::string::npos);
}

}  // namespace
}  // namespace alidade
