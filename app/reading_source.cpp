// SPDX-License-Identifier: Apache-2.0
#include "app/reading_source.h"

#include <filesystem>
#include <system_error>

#include "app/line_image_source.h"
#include "io/reading_file.h"

namespace alidade {
namespace {

class TableSource : public ReadingSource {
 public:
  TableSource(const std::string& source, std::span<const LineDetector> detectors, std::span<const RigidBody> bodies,
              std::stop_token stop)
      : reader_(source, detectors, bodies, std::move(stop)) {
    std::error_code no_size;
    const auto size = source == "-" ? 0 : std::filesystem::file_size(source, no_size);
    if (!no_size) bytes_ = static_cast<std::int64_t>(size);
  }

  std::optional<LineReading> next() override { return reader_.next(); }

  Progress progress(const std::string& stage) const override {
    return {stage + " (kB)", (reader_.bytes() + 999) / 1000, (bytes_ + 999) / 1000, ""};
  }

 private:
  ReadingReader reader_;
  std::int64_t bytes_ = 0;  // of the whole; 0: not known
};

}  // namespace

std::unique_ptr<ReadingSource> open_readings(const std::string& source, std::span<const LineDetector> detectors,
                                             std::span<const RigidBody> bodies, std::stop_token stop) {
  if (source != "-" && std::filesystem::is_directory(source)) {
    return std::make_unique<LineImageSource>(source, detectors, bodies, std::move(stop));
  }
  return std::make_unique<TableSource>(source, detectors, bodies, std::move(stop));
}

std::string name_of_source(const std::string& source) {
  return source == "-" ? "standard input" : source;
}

}  // namespace alidade
