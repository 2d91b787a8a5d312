// SPDX-License-Identifier: Apache-2.0
#include "marker1d/line_signal.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <set>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "datasets/line_image_recording.h"
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

int row_of(const LineReading& reading, const LineImageScene& scene) {
  return static_cast<int>(std::lround(to_seconds(reading.time.time_since_epoch()) * scene.rate_hz));
}

LineSignalOptions options_for(const LineImageScene& scene, const LineDetector& detector) {
  const LineImageNoise noise = noise_of(scene.look);
  LineSignalOptions options;
  options.detector = detector.id;
  options.rate_hz = scene.rate_hz;
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
void add(Score& score, const LineImageScene& scene, const LineDetector& detector, const LineSignalReadings& read) {
  const auto truth = line_image_truth(scene, detector, kRows);
  for (int row = 0; row < kRows; ++row) {
    for (const LineImageTruth& t : truth[static_cast<std::size_t>(row)]) {
      if (t.is_lit && !t.is_hidden) score.truth[{detector.id, row, t.marker}] = t.position_px;
    }
  }
  score.peaks += read.counts.peaks;
  for (const LineReading& reading : read.readings) {
    score.readings.push_back(reading);
    const auto at = score.truth.find({detector.id, row_of(reading, scene), reading.marker});
    if (at == score.truth.end() || std::abs(reading.value - at->second) > 5.0 * reading.sigma) continue;
    ++score.right;
    score.error2 += std::pow(reading.value - at->second, 2);
    score.normalised2 += std::pow((reading.value - at->second) / reading.sigma, 2);
  }
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

Score read_scene(const char* what, const LineImageScene& scene, bool knows_phases = false) {
  Score score;
  for (const LineDetector& detector : scene.detectors) {
    LineSignalOptions options = options_for(scene, detector);
    for (std::size_t m = 0; knows_phases && m < scene.signs.size(); ++m) options.signs[m].phase = scene.phases[m];
    add(score, scene, detector, read_rows(render_line_image(scene, detector, kRows), options));
  }
  print(what, score);
  return score;
}

const LineImageScene& usual_scene() {
  static const LineImageScene scene = line_image_scene(blink_codes(4));
  return scene;
}

const Score& usual_score() {
  static const Score score = read_scene("SNR 10, blinking:", usual_scene());
  return score;
}

// The Cramér–Rao bound of a spot that stands alone, px, averaged over its place in the pixel.
double lone_bound_px(const LineImageLook& look) {
  const LineImageNoise noise = noise_of(look);
  const double s = look.spot_sigma_px, light = look.full_height * (look.ambient + 0.5 * look.gradient);
  double information = 0.0;
  for (double u = -8.0; u <= 8.0; u += 0.1) {
    const double spot = look.full_height * std::exp(-0.5 * u * u / (s * s));
    information += 0.1 * std::pow(spot * u / (s * s), 2) / (noise.read * noise.read + noise.shot * (light + spot));
  }
  return 1.0 / std::sqrt(information);
}

TEST(LineSignal, NamesBlinkingMarkersAtSnrTen) {
  EXPECT_GE(usual_score().right_share(), 0.999) << "wanted: 0.995";
  EXPECT_GE(usual_score().identified_share(), 0.97) << "wanted: 0.95";
  EXPECT_GE(usual_score().found_share(), 0.95);
}

TEST(LineSignal, ReadsToTheCramerRaoBoundAndSaysSo) {
  const Score& score = usual_score();
  const double rms = std::sqrt(score.error2 / static_cast<double>(score.right));
  EXPECT_LE(rms / lone_bound_px(usual_scene().look), 1.15) << "wanted: 1.3";
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
  LineImageScene scene = thinned(usual_scene(), 2);
  scene.hidden_share = 0.6;
  const Score score = read_scene("SNR 10, 60 % hidden:", scene);
  EXPECT_GE(score.right_share(), 0.995);
  EXPECT_GE(score.identified_share(), 0.95);
}

TEST(LineSignal, NamesMarkersWhosePhaseIsKnown) {
  const Score score = read_scene("SNR 10, phases known:", thinned(usual_scene(), 3), true);
  EXPECT_GE(score.right_share(), 0.999);
  EXPECT_GE(score.identified_share(), 0.97);
}

TEST(LineSignal, NamesMarkersByTheirColours) {
  LineImageScene scene = thinned(line_image_scene({"1", "1", "1", "1"}), 4);
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

PoseErrors errors_of(const RowSights& rows, const LineImageScene& scene) {
  PoseErrors sum;
  for (const auto& [row, sights] : rows) {
    const Eigen::Isometry3d truth = T_world_body_in_figures(row / scene.rate_hz);
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
    const auto m = static_cast<std::size_t>(marker - 1);
    return Sight{&scene.detectors[static_cast<std::size_t>(detector)], scene.body.markers[m].p_body, value, sigma};
  };
  for (const LineReading& r : usual_score().readings) {
    from_images[row_of(r, scene)].push_back(sight(r.detector, r.marker, r.value, r.sigma));
  }
  // All lit markers of every row, whether or not they could be told apart, with the noise of a lone spot.
  const double sigma = lone_bound_px(scene.look);
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal(0.0, sigma);
  for (const auto& [key, value] : usual_score().truth) {
    from_truth[key[1]].push_back(sight(key[0], key[2], value + normal(random), sigma));
  }
  std::erase_if(from_truth, is_open);
  std::erase_if(from_images, [&](const auto& row) { return !from_truth.contains(row.first); });
  ASSERT_EQ(from_images.size(), from_truth.size());
  ASSERT_GT(from_truth.size(), static_cast<std::size_t>(kRows / 2));
  const PoseErrors images = errors_of(from_images, scene), truth = errors_of(from_truth, scene);
  std::printf("poses: %.4f mm, %.4f mrad from images; %.4f mm, %.4f mrad from exact values with noise\n",
              1e3 * images.position_m, 1e3 * images.rotation_rad, 1e3 * truth.position_m, 1e3 * truth.rotation_rad);
  EXPECT_LE(images.position_m / truth.position_m, 1.1) << "wanted: 1.2";
  EXPECT_LE(images.rotation_rad / truth.rotation_rad, 1.1) << "wanted: 1.2";
}

TEST(LineSignal, ReadsRowByRowWhatItReadsAtOnce) {
  const LineImageScene& scene = usual_scene();
  const LineDetector& detector = scene.detectors[2];
  const cv::Mat image = render_line_image(scene, detector, 100);
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
  const auto all = read_rows(image, options);
  EXPECT_EQ(count, all.readings.size());
  EXPECT_EQ(signal.counts().identified, all.counts.identified);
  EXPECT_TRUE(std::is_sorted(all.readings.begin(), all.readings.end(),
                             [](const LineReading& a, const LineReading& b) { return a.time < b.time; }));
}

TEST(LineSignal, ReadsFromFilesWhatItReadsFromImages) {
  LineImageScene scene = thinned(usual_scene(), 6);
  const test::TemporaryDirectory folder;
  write_line_images(scene, 60, folder.path());
  const LineImageSet set = read_line_image_set(folder.path());
  ASSERT_EQ(set.detectors.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    LineSignalOptions options;
    options.detector = set.detectors[i].detector;
    options.rate_hz = set.rate_hz;
    options.first_time = set.first_time;
    options.signs = set.signs;
    options.peaks.spot_sigma_px = *set.spot_sigma_px;
    options.peaks.noise = {set.read_noise, set.counts_per_electron};
    const auto from_file = read_rows(read_line_image(set.detectors[i].parts[0]), options);
    const LineDetector& detector = scene.detectors[i];
    const auto direct = read_rows(render_line_image(scene, detector, 60), options_for(scene, detector));
    ASSERT_EQ(from_file.readings.size(), direct.readings.size());
    ASSERT_GT(direct.readings.size(), 100u);
    for (std::size_t k = 0; k < direct.readings.size(); ++k) {
      EXPECT_EQ(from_file.readings[k].detector, detector.id);
      EXPECT_EQ(from_file.readings[k].marker, direct.readings[k].marker);
      EXPECT_NEAR(from_file.readings[k].value, direct.readings[k].value, 1e-6);
    }
  }
}

TEST(LineSignal, GoesOnAfterLostRows) {
  const LineImageScene& scene = usual_scene();
  const LineDetector& detector = scene.detectors[5];
  const cv::Mat image = render_line_image(scene, detector, kRows);
  LineSignal signal(options_for(scene, detector));
  LineSignalReadings read;
  for (int row = 0; row < kRows; ++row) {
    if (row % 50 >= 46 || (row > 300 && row < 340)) continue;
    const auto readings = signal.read_row(image.row(row), row);
    read.readings.insert(read.readings.end(), readings.begin(), readings.end());
  }
  read.counts = signal.counts();
  Score score;
  add(score, scene, detector, read);
  EXPECT_GE(score.right_share(), 0.995);
  EXPECT_GE(score.identified_share(), 0.9);
}

}  // namespace
}  // namespace alidade
