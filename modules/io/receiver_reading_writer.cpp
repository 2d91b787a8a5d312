// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include "core/find_by_id.h"
#include "io/receiver_reading_file.h"

namespace alidade {

ReceiverReadingWriter::ReceiverReadingWriter(const std::filesystem::path& path, std::span<const Receiver> receivers)
    : file_(path), receivers_(receivers.begin(), receivers.end()) {
  has_cameras_ =
      std::any_of(receivers.begin(), receivers.end(), [](const Receiver& r) { return r.camera.has_value(); });
  has_finders_ = std::any_of(receivers.begin(), receivers.end(), [](const Receiver& r) { return !r.camera; });
  std::string header = "t_ns,receiver,target";
  if (has_cameras_) header += ",u_px,v_px,sigma_px";
  if (has_finders_) header += ",azimuth_rad,elevation_rad,sigma_rad";
  file_.write(header + ",temperature_k\n");
}

void ReceiverReadingWriter::write(const ReceiverReading& reading) {
  const Receiver* receiver = find_by_id(std::span<const Receiver>(receivers_), reading.receiver);
  if (!receiver) {
    throw std::invalid_argument(fmt::format("ReceiverReadingWriter::write: no receiver {}", reading.receiver));
  }
  fmt::memory_buffer row;
  const auto out = std::back_inserter(row);
  fmt::format_to(out, "{},{},{}", reading.time.time_since_epoch().count(), reading.receiver, reading.target);
  for (const bool pixels : {true, false}) {
    if (!(pixels ? has_cameras_ : has_finders_)) continue;
    const bool here = receiver->camera.has_value() == pixels;
    here ? fmt::format_to(out, ",{},{}", reading.value[0], reading.value[1]) : fmt::format_to(out, ",,");
    const double sigma =
        std::sqrt(reading.covariance(1, 1));  // of elevation: the azimuth's has grown towards the zenith
    here&& sigma > 0 ? fmt::format_to(out, ",{}", sigma) : fmt::format_to(out, ",");
  }
  fmt::format_to(out, ",");
  if (reading.temperature_k) fmt::format_to(out, "{}", *reading.temperature_k);
  row.push_back('\n');
  file_.write({row.data(), row.size()});
}

}  // namespace alidade
