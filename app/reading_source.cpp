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
    if (source != "-") bytes_ = file_bytes(source);
  }

  std::optional<LineReading> next() override { return reader_.next(); }

  SourceExtent extent() const override { return {reader_.bytes(), bytes_}; }

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

Progress progress_of(const ReadingSource& source, const std::string& stage) {
  const SourceExtent extent = source.extent();
  return {stage + " (kB)", (extent.done + 999) / 1000, (extent.total + 999) / 1000, ""};
}

std::int64_t file_bytes(const std::filesystem::path& path) {
  std::error_code none;
  const auto size = std::filesystem::file_size(path, none);
  return none ? 0 : static_cast<std::int64_t>(size);
}

std::string name_of_source(const std::string& source) {
  return source == "-" ? "standard input" : source;
}

}  // namespace alidade
