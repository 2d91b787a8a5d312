// SPDX-License-Identifier: Apache-2.0
#include "marker1d/line_signal.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <set>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "datasets/line_image_files.h"
#include "datasets/line_image_scene.h"
#include "geometry/pose.h"
#include "geometry/rotation.h"
#include "io/image_files.h"
#include "io/line_images.h"
#include "marker1d/blink_code.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

constexpr int kRows = 600;

LineImageScene scene_with(const std::vector<std::string>& codes, double occluded = 0.0) {
  BodySceneOptions options;
  options.frames = kRows;
  options.occluded = occluded;
  return line_image_scene(options, codes);
}

const LineImageScene& usual_scene() {
  static const LineImageScene scene = scene_with(blink_codes(4));
  return scene;
}

LineImageBlock recorded(const LineImageScene& scene) {
  return LineImageRecording(scene).next(kRows).value();
}

const LineImageBlock& usual_recording() {
  static const LineImageBlock block = recorded(usual_scene());
  return block;
}

int row_of(const LineReading& reading, const LineImageScene& scene) {
  return static_cast<int>(std::lround(to_seconds(reading.time.time_since_epoch()) * scene.scene.rate_hz));
}

LineSignalOptions options_for(const LineImageScene& scene, const LineDetector& detector) {
  const LineImageNoise noise = noise_of(scene.look);
  LineSignalOptions options;
  options.detector = detector.id;
  options.rate_hz = scene.scene.rate_hz;
  options.signs = scene.signs;
  options.peaks.noise = {noise.read, noise.shot};
  return options;
}

// (detector, row, marker) → where the lit marker's spot is, px.
using Key = std::array<int, 3>;

struct Score {
  std::vector<LineReading> readings;
  std::map<Key, double> truth;
  std::int64_t peaks = 0, right = 0;
  double error2 = 0.0, normalised2 = 0.0;

  double right_share() const { return static_cast<double>(right) / static_cast<double>(readings.size()); }
  double identified_share() const { return static_cast<double>(readings.size()) / static_cast<double>(peaks); }
  double found_share() const { return static_cast<double>(right) / static_cast<double>(truth.size()); }
};

// Right is a reading within five standard deviations of the marker that it names, which must be lit and in view.
void add(Score& score, const LineImageScene& scene, const std::vector<LineReading>& readings) {
  for (const LineReading& reading : readings) {
    score.readings.push_back(reading);
    const auto at = score.truth.find({reading.detector, row_of(reading, scene), reading.marker});
    if (at == score.truth.end() || std::abs(reading.value - at->second) > 5.0 * reading.sigma) continue;
    ++score.right;
    score.error2 += std::pow(reading.value - at->second, 2);
    score.normalised2 += std::pow((reading.value - at->second) / reading.sigma, 2);
  }
}

Score score_against(const LineImageScene& scene, const LineImageBlock& block) {
  Score score;
  for (const BodySceneFrame& frame : block.frames) {
    for (const LineReading& r : frame.readings) score.truth[{r.detector, row_of(r, scene), r.marker}] = r.value;
  }
  return score;
}

void print(const char* what, const Score& score) {
  std::printf("%-28s ids right %.3f %%, identified %.2f %% of spots, right %.2f %% of lit markers, rms %.4f px\n", what,
              100.0 * score.right_share(), 100.0 * score.identified_share(), 100.0 * score.found_share(),
              std::sqrt(score.error2 / static_cast<double>(score.right)));
}

// Of every `step`-th detector.
LineImageScene thinned(LineImageScene scene, std::size_t step) {
  std::vector<LineDetector> kept;
  for (std::size_t i = 0; i < scene.detectors.size(); i += step) kept.push_back(scene.detectors[i]);
  scene.detectors = kept;
  return scene;
}

std::vector<LineReading> read_all(LineSignals& signals, const std::vector<cv::Mat>& images) {
  auto readings = signals.read(images);
  const auto last = signals.finish();
  readings.insert(readings.end(), last.begin(), last.end());
  return readings;
}

Score read_scene(const char* what, const LineImageScene& scene, const LineImageBlock& block,
                 bool knows_phases = false) {
  std::vector<LineSignalOptions> options;
  for (const LineDetector& detector : scene.detectors) {
    options.push_back(options_for(scene, detector));
    for (std::size_t m = 0; knows_phases && m < scene.signs.size(); ++m) {
      options.back().signs[m].phase = scene.phases[m];
    }
  }
  LineSignals signals(options);
  Score score = score_against(scene, block);
  add(score, scene, read_all(signals, block.images));
  for (const LineSignalCounts& counts : signals.counts()) score.peaks += counts.peaks;
  print(what, score);
  return score;
}

Score read_scene(const char* what, const LineImageScene& scene, bool knows_phases = false) {
  return read_scene(what, scene, recorded(scene), knows_phases);
}

const Score& usual_score() {
  static const Score score = read_scene("SNR 10, blinking:", usual_scene(), usual_recording());
  return score;
}

TEST(LineSignal, NamesBlinkingMarkersAtSnrTen) {
  EXPECT_GE(usual_score().right_share(), 0.999) << "wanted: 0.995";
  EXPECT_GE(usual_score().identified_share(), 0.97) << "wanted: 0.95";
  EXPECT_GE(usual_score().found_share(), 0.95);
}

TEST(LineSignal, ReadsToTheCramerRaoBoundAndSaysSo) {
  const Score& score = usual_score();
  const double rms = std::sqrt(score.error2 / static_cast<double>(score.right));
  EXPECT_LE(rms / lone_spot_bound_px(usual_scene().look), 1.15) << "wanted: 1.3";
  EXPECT_NEAR(std::sqrt(score.normalised2 / static_cast<double>(score.right)), 1.0, 0.05);
}

TEST(LineSignal, NamesMarkersInFaintAndInBrightLight) {
  LineImageScene scene = thinned(usual_scene(), 3);
  scene.look.snr = 5.0;
  const Score faint = read_scene("SNR 5, blinking:", scene);
  EXPECT_GE(faint.right_share(), 0.995);
  EXPECT_GE(faint.identified_share(), 0.95);
  scene.look.snr = 100.0;
  scene.look.full_height = 12000.0;
  const Score bright = read_scene("SNR 100, 16 bits, blinking:", scene);
  EXPECT_GE(bright.right_share(), 0.995);
  EXPECT_GE(bright.identified_share(), 0.97);
}

TEST(LineSignal, NamesMarkersThatAreHiddenMostOfTheTime) {
  const LineImageScene scene = thinned(scene_with(blink_codes(4), 0.6), 2);
  const Score score = read_scene("SNR 10, 60 % hidden:", scene);
  EXPECT_GE(score.right_share(), 0.995);
  EXPECT_GE(score.identified_share(), 0.95);
}

int rows_until_named(const LineSignalOptions& options, const cv::Mat& image) {
  LineSignal signal(options);
  int row = 0;
  while (row < image.rows && signal.read_row(image.row(row), row).empty()) ++row;
  return row;
}

TEST(LineSignal, NamesMarkersSoonerWhosePhaseIsKnown) {
  const LineImageScene scene = thinned(usual_scene(), 3);
  const LineImageBlock block = recorded(scene);
  const Score score = read_scene("SNR 10, phases known:", scene, block, true);
  EXPECT_GE(score.right_share(), 0.999);
  EXPECT_GE(score.identified_share(), 0.95);
  for (std::size_t d = 0; d < scene.detectors.size(); ++d) {
    LineSignalOptions options = options_for(scene, scene.detectors[d]);
    const int unknown = rows_until_named(options, block.images[d]);
    for (std::size_t m = 0; m < scene.signs.size(); ++m) options.signs[m].phase = scene.phases[m];
    EXPECT_LT(rows_until_named(options, block.images[d]), unknown);
  }
}

TEST(LineSignal, NamesMarkersByTheirColours) {
  LineImageScene scene = thinned(scene_with({"1", "1", "1", "1"}), 4);
  const std::array<std::array<double, 3>, 4> colours{{{1, 0.1, 0.1}, {0.1, 1, 0.1}, {0.1, 0.1, 1}, {1, 1, 1}}};
  for (std::size_t m = 0; m < 4; ++m) scene.signs[m].colour = colours[m];
  scene.look.snr = 20.0;  // of a spot whose light falls into one channel alone
  const Score score = read_scene("SNR 20, coloured:", scene);
  EXPECT_GE(score.right_share(), 0.995);
  EXPECT_GE(score.identified_share(), 0.92) << "no row has one of two crossing markers alone";
}

// A reading and what it is of.
struct Sight {
  const LineDetector* detector;
  Eigen::Vector3d p_body;
  double value, sigma;
};

// Least squares by Gauss–Newton; what lies beyond five standard deviations has no weight.
Eigen::Isometry3d pose_from(const std::vector<Sight>& sights, Eigen::Isometry3d T) {
  for (int step = 0; step < 6; ++step) {
    Matrix6d A = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    for (const Sight& sight : sights) {
      const auto seen = project(*sight.detector, T * sight.p_body);
      if (!seen) continue;
      const double residual = sight.value - seen->value;
      if (std::abs(residual) > 5.0 * sight.sigma && step > 0) continue;
      if (std::abs(residual) > 20.0 * sight.sigma) continue;
      Eigen::Matrix<double, 1, 6> J;
      J.head<3>() = seen->J_value_point * T.linear();
      J.tail<3>() = -seen->J_value_point * T.linear() * skew(sight.p_body);
      J /= sight.sigma;
      A += J.transpose() * J;
      g += J.transpose() * residual / sight.sigma;
    }
    T = T * perturbation(A.ldlt().solve(g));
  }
  return T;
}

using RowSights = std::map<int, std::vector<Sight>>;

struct PoseErrors {
  double position_m = 0.0, rotation_rad = 0.0;  // RMS
};

PoseErrors errors_of(const RowSights& rows) {
  PoseErrors sum;
  for (const auto& [row, sights] : rows) {
    const Eigen::Isometry3d truth = pose_in_scene(0, usual_recording().frames[static_cast<std::size_t>(row)].time);
    const Vector6d error = difference(truth, pose_from(sights, truth));
    sum.position_m += error.head<3>().squaredNorm();
    sum.rotation_rad += error.tail<3>().squaredNorm();
  }
  const double count = static_cast<double>(rows.size());
  return {std::sqrt(sum.position_m / count), std::sqrt(sum.rotation_rad / count)};
}

// Two markers leave the turn about the line through them open: such rows say nothing of the signal.
bool is_open(const RowSights::value_type& row) {
  std::set<double> markers;
  for (const Sight& sight : row.second) markers.insert(sight.p_body.x());
  return markers.size() < 3;
}

TEST(LineSignal, GivesPosesAlmostAsGoodAsExactPlanesWithTheSameNoise) {
  const LineImageScene& scene = usual_scene();
  RowSights from_images, from_truth;
  const auto sight = [&](int detector, int marker, double value, double sigma) {
    const auto m = static_cast<std::size_t>(marker);
    return Sight{&scene.detectors[static_cast<std::size_t>(detector)], scene.bodies[0].markers[m].p_body, value, sigma};
  };
  for (const LineReading& r : usual_score().readings) {
    from_images[row_of(r, scene)].push_back(sight(r.detector, r.marker, r.value, r.sigma));
  }
  // All lit markers of every row, whether or not they could be told apart, with the noise of a lone spot.
  const double sigma = lone_spot_bound_px(scene.look);
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal(0.0, sigma);
  for (const auto& [key, value] : usual_score().truth) {
    from_truth[key[1]].push_back(sight(key[0], key[2], value + normal(random), sigma));
  }
  std::erase_if(from_truth, is_open);
  std::erase_if(from_images, [&](const auto& row) { return !from_truth.contains(row.first); });
  ASSERT_EQ(from_images.size(), from_truth.size());
  ASSERT_GT(from_truth.size(), static_cast<std::size_t>(kRows / 2));
  const PoseErrors images = errors_of(from_images), truth = errors_of(from_truth);
  std::printf("poses: %.4f mm, %.4f mrad from images; %.4f mm, %.4f mrad from exact values with noise\n",
              1e3 * images.position_m, 1e3 * images.rotation_rad, 1e3 * truth.position_m, 1e3 * truth.rotation_rad);
  EXPECT_LE(images.position_m / truth.position_m, 1.1) << "wanted: 1.2";
  EXPECT_LE(images.rotation_rad / truth.rotation_rad, 1.1) << "wanted: 1.2";
}

TEST(LineSignal, ReadsRowByRowWhatItReadsAtOnce) {
  const LineImageScene& scene = usual_scene();
  const LineDetector& detector = scene.detectors[2];
  const cv::Mat image = usual_recording().images[2].rowRange(0, 100);
  const LineSignalOptions options = options_for(scene, detector);
  LineSignal signal(options);
  std::size_t count = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (const LineReading& reading : signal.read_row(image.row(row), row)) {
      EXPECT_EQ(reading.detector, detector.id);
      EXPECT_GE(row_of(reading, scene), row - options.tracker.most_delay_rows);
      ++count;
    }
  }
  LineSignals signals({options});
  const auto all = read_all(signals, {image});
  EXPECT_EQ(count, all.size());
  EXPECT_EQ(signal.counts().identified, signals.counts()[0].identified);
}

TEST(LineSignals, GivesReadingsInOrderOfTimeHoweverTheRowsCome) {
  const LineImageScene scene = thinned(usual_scene(), 5);
  std::vector<LineSignalOptions> options;
  std::vector<cv::Mat> images;
  for (std::size_t d = 0; d < scene.detectors.size(); ++d) {
    options.push_back(options_for(scene, scene.detectors[d]));
    images.push_back(usual_recording().images[5 * d]);
  }
  LineSignals at_once(options), in_parts(options);
  const auto expected = read_all(at_once, images);
  std::vector<LineReading> readings;
  for (int first = 0; first < kRows; first += 37) {
    std::vector<cv::Mat> part;
    for (const cv::Mat& image : images) part.push_back(image.rowRange(first, std::min(kRows, first + 37)));
    const auto read = in_parts.read(part);
    readings.insert(readings.end(), read.begin(), read.end());
  }
  const auto last = in_parts.finish();
  readings.insert(readings.end(), last.begin(), last.end());
  ASSERT_EQ(readings.size(), expected.size());
  EXPECT_GT(readings.size(), 1000u);
  for (std::size_t i = 1; i < readings.size(); ++i) EXPECT_LE(readings[i - 1].time, readings[i].time);
}

TEST(LineSignals, TakesNoRowsForLostOnes) {
  const LineImageScene scene = thinned(usual_scene(), 6);
  LineSignals signals({options_for(scene, scene.detectors[0]), options_for(scene, scene.detectors[1])});
  const auto readings = read_all(signals, {cv::Mat(), usual_recording().images[6]});
  ASSERT_FALSE(readings.empty());
  for (const LineReading& reading : readings) EXPECT_EQ(reading.detector, scene.detectors[1].id);
  EXPECT_THROW(signals.read({}), std::invalid_argument);
}

TEST(LineSignals, ReadFromFilesWhatTheyReadFromImages) {
  LineImageScene scene = thinned(usual_scene(), 6);
  scene.scene.frames = 60;
  const test::TemporaryDirectory folder;
  LineImageFilesWriter writer(scene, folder.path());
  LineImageRecording recording(scene);
  while (const auto block = recording.next(40)) writer.write(*block);
  writer.commit();
  const LineImageSet set = read_line_image_set(folder.path());
  ASSERT_EQ(set.detectors.size(), 2u);
  const auto direct = recorded(scene);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(set.detectors[i].parts.size(), 2u);
    cv::Mat rows;
    cv::vconcat(read_line_image(set.detectors[i].parts[0]), read_line_image(set.detectors[i].parts[1]), rows);
    EXPECT_EQ(cv::norm(rows, direct.images[i], cv::NORM_INF), 0.0);
  }
}

TEST(LineSignal, GoesOnAfterLostRows) {
  const LineImageScene& scene = usual_scene();
  const LineDetector& detector = scene.detectors[5];
  const cv::Mat image = usual_recording().images[5];
  LineSignal signal(options_for(scene, detector));
  std::vector<LineReading> read;
  for (int row = 0; row < kRows; ++row) {
    if (row % 50 >= 46 || (row > 300 && row < 340)) continue;
    const auto readings = signal.read_row(image.row(row), row);
    read.insert(read.end(), readings.begin(), readings.end());
  }
  Score score = score_against(scene, usual_recording());
  add(score, scene, read);
  score.peaks = signal.counts().peaks;
  EXPECT_GE(score.right_share(), 0.995);
  EXPECT_GE(score.identified_share(), 0.9);
}

}  // namespace
}  // namespace alidade
