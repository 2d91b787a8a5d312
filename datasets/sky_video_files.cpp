// SPDX-License-Identifier: Apache-2.0
#include "datasets/sky_video_files.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "io/table.h"
#include "io/video_writer.h"

namespace alidade {
namespace {

constexpr std::array<std::string_view, 9> kColumns{"t_ns",        "receiver",    "target",  "u_px", "v_px",
                                                   "steady_u_px", "steady_v_px", "size_px", "snr"};

void write_truth(const SkyFrame& frame, const std::string& receiver, TableWriter& table) {
  for (const DotSighting& dot : frame.sightings) {
    table.write_row({static_cast<std::int64_t>(frame.time.time_since_epoch().count()), receiver,
                     static_cast<std::int64_t>(dot.target), dot.pixel.x(), dot.pixel.y(), dot.steady_pixel.x(),
                     dot.steady_pixel.y(), dot.size_px, dot.snr});
  }
}

}  // namespace

std::vector<std::string> write_sky_videos(const SkyScene& scene, const std::filesystem::path& directory,
                                          const ProgressSink& progress, std::stop_token stop) {
  TableWriter truth(directory / "truth_pixels.csv", kColumns);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < scene.receivers.size(); ++k) {
    SkyVideo video(scene, k);
    const Receiver& receiver = scene.receivers[k];
    names.push_back(receiver.name + ".mkv");
    VideoWriter writer(directory / names.back(), {receiver.camera->width, receiver.camera->height},
                       {VideoKind::Lossless, scene.fps_hz[k]});
    const auto total = static_cast<std::int64_t>(std::ceil(scene.duration_s * scene.fps_hz[k]));
    std::int64_t done = 0;
    while (const auto frame = video.next()) {
      if (stop.stop_requested()) break;
      writer.write(frame->image);
      write_truth(*frame, receiver.name, truth);
      if (progress) progress({"filming, " + receiver.name, ++done, total, ""});
    }
    writer.close();
  }
  truth.commit();
  return names;
}

}  // namespace alidade
