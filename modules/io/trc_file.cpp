// SPDX-License-Identifier: Apache-2.0
#include "io/trc_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include "core/errors.h"

namespace alidade {
namespace {

// Tabs part the cells, and readers take other blanks for the end of a name.
std::string without_blanks(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c <= ' '; }, '_');
  return name;
}

// Whole µm: the format is for gait and gestures; the poses are elsewhere to the last digit. Zero has no sign.
double rounded(double metres) {
  return std::round(1e6 * metres) / 1e6 + 0.0;
}

void append_file(const std::filesystem::path& from, AtomicFile& to) {
  std::ifstream rows(from, std::ios::binary);
  std::string block(1 << 18, '\0');
  while (rows) {
    rows.read(block.data(), static_cast<std::streamsize>(block.size()));
    to.write(std::string_view(block).substr(0, static_cast<std::size_t>(rows.gcount())));
  }
  if (!rows.eof()) throw DeviceError(from, "cannot be read", "it was just written", "check the disk and run it again");
}

}  // namespace

TrcWriter::TrcWriter(std::filesystem::path path, std::vector<std::string> marker_names)
    : path_(std::move(path)), rows_path_(path_.string() + ".rows"), names_(std::move(marker_names)), rows_(rows_path_) {
  if (names_.empty()) throw std::invalid_argument("TrcWriter: at least one marker");
  for (std::string& name : names_) name = without_blanks(std::move(name));
}

TrcWriter::~TrcWriter() {
  std::error_code ignored;
  std::filesystem::remove(rows_path_, ignored);
}

void TrcWriter::write(Timestamp time, std::span<const std::optional<Eigen::Vector3d>> p_world) {
  if (p_world.size() != names_.size()) {
    throw std::invalid_argument(
        fmt::format("TrcWriter::write: {} positions for {} markers", p_world.size(), names_.size()));
  }
  if (count_++ == 0) first_ = time;
  last_ = time;
  std::string row = fmt::format("{}\t{}", count_, format_seconds(time));
  for (const auto& p : p_world) {
    row += p ? fmt::format("\t{:.6f}\t{:.6f}\t{:.6f}", rounded(p->x()), rounded(p->z()), rounded(-p->y())) : "\t\t\t";
  }
  rows_.write(row + '\n');
}

std::string TrcWriter::head() const {
  const double rate_hz = last_ > first_ ? static_cast<double>(count_ - 1) / to_seconds(last_ - first_) : 0.0;
  std::string text = fmt::format("PathFileType\t4\t(X/Y/Z)\t{}\n", path_.filename().string());
  text += "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n";
  text += fmt::format("{0:.6g}\t{0:.6g}\t{1}\t{2}\tm\t{0:.6g}\t1\t{1}\n", rate_hz, count_, names_.size());
  std::string axes = "\t";
  text += "Frame#\tTime";
  for (std::size_t i = 0; i < names_.size(); ++i) {
    text += fmt::format("\t{}\t\t", names_[i]);
    axes += fmt::format("\tX{0}\tY{0}\tZ{0}", i + 1);
  }
  return text + '\n' + axes + "\n\n";
}

void TrcWriter::commit() {
  rows_.commit();
  AtomicFile file(path_);
  file.write(head());
  append_file(rows_path_, file);
  file.commit();
  std::filesystem::remove(rows_path_);
}

}  // namespace alidade
