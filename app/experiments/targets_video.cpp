// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "app/experiments/cpu_clock.h"
#include "app/experiments/targets_experiment.h"
#include "app/experiments/targets_video_chain.h"
#include "datasets/sky_scene.h"
#include "evaluation/detection_tally.h"
#include "uav/video/mixture_blobs.h"
#include "uav/video/moving_objects.h"

namespace alidade {
namespace {

constexpr std::array<double, 4> kSizes_px{2.0, 3.0, 4.0, 6.0};
constexpr std::array<double, 3> kSnrs{3.0, 5.0, 8.0};
constexpr int kWarmUp = 30;
constexpr int kVideoFrames = 150;  // of each video that count
constexpr double kFps = 30.0;

struct Condition {
  const char* name;
  double shake_px;
};
constexpr std::array<Condition, 2> kConditions{Condition{"still", 0.0}, Condition{"swaying", 0.8}};

// A way to detect, at one of its thresholds, and what it found.
struct Contender {
  std::string name;
  bool is_steady;  // tells pixels as if the camera did not sway
  DetectionTally tally;
};

DetectionTally empty_tally() {
  constexpr double kRadius_px = 3.0, kAlone_px = 12.0;
  return {kSizes_px.size() * kSnrs.size(), kRadius_px, kAlone_px};
}

int kind_of(std::size_t size, std::size_t snr) {
  return static_cast<int>(size * kSnrs.size() + snr);
}

// One target of each size and SNR; dark and bright ones by turns.
SkySceneOptions scene_options(const Condition& condition, unsigned seed) {
  SkySceneOptions options;
  options.receivers = 1;
  options.width = 960;
  options.height = 540;
  options.focal_px = 675.0;
  options.fps_hz = kFps;
  options.duration_s = (kWarmUp + kVideoFrames) / kFps;
  options.dots.clear();
  for (const double size : kSizes_px) {
    for (const double snr : kSnrs) options.dots.push_back({size, snr, (options.dots.size() + seed) % 2 == 0});
  }
  options.look.shake_px = condition.shake_px;
  options.look.shake_roll_rad = 3e-4 * condition.shake_px;
  options.seed = options.look.seed = options.look.backdrop.seed = seed;
  return options;
}

std::vector<TrueDot> truth_of(const SkyFrame& frame, bool is_steady) {
  std::vector<TrueDot> truth;
  for (const DotSighting& dot : frame.sightings) {
    truth.push_back({is_steady ? dot.steady_pixel : dot.pixel, dot.target});  // targets are in the order of kinds
  }
  return truth;
}

constexpr std::array<double, 4> kEvidences{6.5, 7.5, 9.0, 14.0};
constexpr std::array<double, 4> kVarianceThresholds{9.0, 16.0, 36.0, 64.0};

std::vector<Contender> make_contenders() {
  std::vector<Contender> contenders;
  for (const double evidence : kEvidences)
    contenders.push_back({fmt::format("ours, evidence {:g}", evidence), true, empty_tally()});
  for (const double threshold : kVarianceThresholds) {
    contenders.push_back({fmt::format("MOG2, variance threshold {:g}", threshold), false, empty_tally()});
  }
  return contenders;
}

using Detect = std::function<std::vector<DetectedDot>(const SkyFrame&)>;

Detect ours(double evidence) {
  MovingObjectOptions options;
  options.warm_up_frames = kWarmUp;
  options.tracks.least_evidence = evidence;
  return [detector = MovingObjectDetector(options)](const SkyFrame& frame) mutable {
    std::vector<DetectedDot> dots;
    for (const MovingObject& object : detector.detect(frame.image, frame.time)) {
      dots.push_back({object.pixel, object.covariance});
    }
    return dots;
  };
}

Detect mixture(double threshold) {
  MixtureBlobOptions options;
  options.variance_threshold = threshold;
  return [detector = MixtureBlobDetector(options)](const SkyFrame& frame) mutable {
    std::vector<DetectedDot> dots;
    for (const Eigen::Vector2d& pixel : detector.detect(frame.image)) dots.push_back({pixel});
    return dots;
  };
}

void watch_video(const SkyScene& scene, std::vector<Contender>& contenders, const ExperimentContext& context) {
  std::vector<Detect> detect;
  for (const double evidence : kEvidences) detect.push_back(ours(evidence));
  for (const double threshold : kVarianceThresholds) detect.push_back(mixture(threshold));
  SkyVideo video(scene, 0);
  for (int i = 0; const auto frame = video.next(); ++i) {
    if (context.stop.stop_requested()) return;
    for (std::size_t k = 0; k < detect.size(); ++k) {
      const std::vector<DetectedDot> dots = detect[k](*frame);
      if (i >= kWarmUp) contenders[k].tally.add(truth_of(*frame, contenders[k].is_steady), dots);
    }
  }
}

// What the acceptance is about: SNR >= 5 and size >= 3 px.
std::vector<int> plain_kinds() {
  std::vector<int> kinds;
  for (std::size_t size = 0; size < kSizes_px.size(); ++size) {
    for (std::size_t snr = 0; snr < kSnrs.size(); ++snr) {
      if (kSizes_px[size] >= 3.0 && kSnrs[snr] >= 5.0) kinds.push_back(kind_of(size, snr));
    }
  }
  return kinds;
}

constexpr std::size_t kOurs = 2, kMixture = kEvidences.size() + 1;  // as they come

void add_cells(const std::string& condition, const std::vector<Contender>& contenders, ExperimentSection& section) {
  for (std::size_t size = 0; size < kSizes_px.size(); ++size) {
    for (std::size_t snr = 0; snr < kSnrs.size(); ++snr) {
      const auto kind = static_cast<std::size_t>(kind_of(size, snr));
      const KindTally &own = contenders[kOurs].tally.kinds()[kind], &peer = contenders[kMixture].tally.kinds()[kind];
      section.tables[0].rows.push_back(
          {condition, fmt::format("{:g}", kSizes_px[size]), fmt::format("{:g}", kSnrs[snr]), std::to_string(own.there),
           fmt::format("{:.3f}", own.probability()), fmt::format("{:.3f}", own.rms_px()),
           fmt::format("{:.2f}", own.nees_per_degree()), fmt::format("{:.3f}", peer.probability()),
           fmt::format("{:.3f}", peer.rms_px())});
      section.summary["cells"][condition][fmt::format("{:g} px, SNR {:g}", kSizes_px[size], kSnrs[snr])] = {
          {"probability", own.probability()},
          {"rms_px", own.rms_px()},
          {"nees_per_dof", own.nees_per_degree()},
          {"mog2_probability", peer.probability()},
          {"mog2_rms_px", peer.rms_px()}};
    }
  }
}

void add_thresholds(const std::string& condition, const std::vector<Contender>& contenders,
                    ExperimentSection& section) {
  for (const Contender& contender : contenders) {
    const KindTally plain = contender.tally.together(plain_kinds());
    const double false_ones = contender.tally.false_per_image();
    section.tables[1].rows.push_back(
        {condition, contender.name, fmt::format("{:.3f}", plain.probability()), fmt::format("{:.3f}", false_ones)});
    section.summary["thresholds"][condition][contender.name] = {{"probability", plain.probability()},
                                                                {"false_per_frame", false_ones}};
  }
  const KindTally plain = contenders[kOurs].tally.together(plain_kinds());
  const KindTally peer = contenders[kMixture].tally.together(plain_kinds());
  double least = 1.0;
  for (const int kind : plain_kinds()) {
    least = std::min(least, contenders[kOurs].tally.kinds()[static_cast<std::size_t>(kind)].probability());
  }
  section.summary["accepted"][condition] = {{"probability", plain.probability()},
                                            {"least_cell", least},
                                            {"false_per_frame", contenders[kOurs].tally.false_per_image()},
                                            {"nees_per_dof", plain.nees_per_degree()},
                                            {"rms_px", plain.rms_px()},
                                            {"mog2_probability", peer.probability()},
                                            {"mog2_false_per_frame", contenders[kMixture].tally.false_per_image()}};
}

// Frames per second of one core, the least time of the frames' tenths.
double frames_per_s(const Condition& condition, const ExperimentContext& context) {
  constexpr int kBatches = 6, kPerBatch = 10;
  SkySceneOptions options = scene_options(condition, context.seed);
  options.width = 1280;
  options.height = 720;
  options.focal_px = 900.0;
  const SkyScene scene = make_sky_scene(options);
  SkyVideo video(scene, 0);
  MovingObjectDetector detector;
  for (int i = 0; i < kWarmUp; ++i) {
    const auto frame = video.next();
    detector.detect(frame->image, frame->time);
  }
  const int threads = cv::getNumThreads();
  double least_s = std::numeric_limits<double>::infinity();
  for (int batch = 0; batch < kBatches; ++batch) {
    std::vector<SkyFrame> frames;
    for (int i = 0; i < kPerBatch; ++i) frames.push_back(*video.next());
    cv::setNumThreads(1);
    const double start = thread_seconds();
    for (const SkyFrame& frame : frames) detector.detect(frame.image, frame.time);
    least_s = std::min(least_s, (thread_seconds() - start) / kPerBatch);
    cv::setNumThreads(threads);
  }
  return 1.0 / least_s;
}

ExperimentSection empty_section() {
  return {
      "video",
      "From videos: detection of small moving objects, and tracks from them",
      {"Rendered skies with drifting clouds above textured ground, 960 x 540 px, 30 frames/s, with noise of read-out "
       "and light; twelve targets fly in each video. SNR is the contrast of a target's disc over the noise of a pixel. "
       "Swaying: 0.8 px RMS and 0.24 mrad of roll, unknown to the detectors. A detection within 3 px of a target is "
       "of it. MOG2: OpenCV's, with connected components of 2 to 150 px as blobs, in the frames "
       "as they are."},
      {{"Detection by size and SNR",
        {"camera", "size (px)", "SNR", "frames", "Pd", "centre RMS (px)", "NEES / dof", "Pd of MOG2",
         "its centre RMS (px)"},
        {}},
       {"Detection against false alarms, SNR >= 5 and size >= 3 px",
        {"camera", "detector", "Pd", "false per frame"},
        {}},
       {"Speed at 1280 x 720, one core", {"camera", "frames per second"}, {}}},
      {},
      {}};
}

}  // namespace

ExperimentSection targets_video(const ExperimentContext& context) {
  ExperimentSection section = empty_section();
  const int videos = std::max(1, context.runs / kVideoFrames);
  for (const Condition& condition : kConditions) {
    std::vector<Contender> contenders = make_contenders();
    for (int i = 0; i < videos; ++i) {
      const unsigned seed = context.seed + static_cast<unsigned>(i);
      watch_video(make_sky_scene(scene_options(condition, seed)), contenders, context);
      if (context.stop.stop_requested()) return section;
      if (context.progress) context.progress({fmt::format("video, {}", condition.name), i + 1, videos, ""});
    }
    add_cells(condition.name, contenders, section);
    add_thresholds(condition.name, contenders, section);
  }
  for (const Condition& condition : kConditions) {
    const double rate = frames_per_s(condition, context);
    section.tables[2].rows.push_back({condition.name, fmt::format("{:.0f}", rate)});
    section.summary["speed"][condition.name] = {{"frames_per_s", rate}};
  }
  add_video_chain(context, section);
  return section;
}

}  // namespace alidade
