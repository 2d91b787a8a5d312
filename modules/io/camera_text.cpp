// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <fmt/format.h>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "io/camera_records.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

double* value_named(Camera& c, std::string_view name) {
  auto& k = std::get<BrownConrady>(c.distortion);
  const std::pair<std::string_view, double*> values[] = {{"fx", &c.fx}, {"fy", &c.fy}, {"cx", &c.cx},
                                                         {"cy", &c.cy}, {"k1", &k.k1}, {"k2", &k.k2},
                                                         {"p1", &k.p1}, {"p2", &k.p2}, {"k3", &k.k3}};
  for (const auto& [known, value] : values) {
    if (known == name) return value;
  }
  return nullptr;
}

constexpr std::array<std::string_view, 11> kWords{"fx", "fy", "cx", "cy",    "k1",    "k2",
                                                  "p1", "p2", "k3", "width", "height"};

void set_word(const Path& path, int line, std::string_view name, std::string_view value, CameraRecord& record) {
  if (name == "width" || name == "height") {
    const int size = parse_size(path, line, value);
    (name == "width" ? record.camera.width : record.camera.height) = size;
    record.lines["image"] = line;
    return;
  }
  double* const number = value_named(record.camera, name);
  if (!number) throw InputError(path, line, fmt::format("unknown name '{}'", name), suggest_name(name, kWords));
  *number = parse_number(path, line, value);
  record.lines[std::string(name)] = line;
}

std::vector<double> matrix_rows(const Path& path, std::span<const TextLine> lines) {
  std::vector<double> numbers;
  for (const TextLine& line : lines) {
    const std::vector<double> row = parse_numbers(path, line);
    if (row.size() != 3) {
      throw InputError(path, line.number, fmt::format("has {} numbers, a row of a matrix has 3", row.size()), "");
    }
    numbers.insert(numbers.end(), row.begin(), row.end());
  }
  return numbers;
}

}  // namespace

CameraRecords parse_camera_words(const Path& path, const std::vector<TextLine>& lines) {
  CameraRecord record;
  record.name = "camera";
  record.line = lines.front().number;
  for (const TextLine& line : lines) {
    const auto words = split_words(line.text);
    if (words.size() % 2 != 0) {
      throw InputError(path, line.number, fmt::format("'{}' has no value", words.back()),
                       "pairs like 'fx 500' are wanted");
    }
    for (std::size_t i = 0; i < words.size(); i += 2) set_word(path, line.number, words[i], words[i + 1], record);
  }
  for (const char* name : {"fx", "fy", "cx", "cy"}) {
    if (!record.lines.contains(name)) throw InputError(path, 0, fmt::format("the camera has no '{}'", name), "");
  }
  return {record};
}

CameraRecords parse_kitti_calibration(const Path& path, const std::vector<TextLine>& lines) {
  CameraRecords records;
  for (const TextLine& line : lines) {
    const std::size_t colon = line.text.find(':');
    const bool named = colon != std::string::npos;
    if (named && line.text.front() != 'P') continue;  // Tr, R_rect_00, S_00 and the like
    const TextLine numbers{line.number, named ? line.text.substr(colon + 1) : line.text};
    const std::vector<double> P = parse_numbers(path, numbers);
    if (P.size() != 12) {
      throw InputError(path, line.number, fmt::format("has {} numbers, a 3x4 projection matrix has 12", P.size()), "");
    }
    CameraRecord record;
    record.name = named ? line.text.substr(0, colon) : fmt::format("P{}", records.size());
    record.line = line.number;
    const double K[] = {P[0], P[1], P[2], P[4], P[5], P[6], P[8], P[9], P[10]};
    set_intrinsics(path, line.number, K, record.camera);
    records.push_back(record);
  }
  return records;
}

CameraRecords parse_camera_matrix(const Path& path, const std::vector<TextLine>& lines) {
  if (lines.size() != 3 && lines.size() != 9) {
    throw InputError(path, 0, fmt::format("has {} lines, a camera matrix has 3 and Strecha's *.camera 9", lines.size()),
                     "the file may be cut off");
  }
  CameraRecord record;
  record.name = path.filename();
  record.line = lines.front().number;
  set_intrinsics(path, record.line, matrix_rows(path, std::span(lines).first(3)), record.camera);
  if (lines.size() == 3) return {record};
  for (const double value : matrix_rows(path, std::span(lines).subspan(3, 1))) {
    if (value == 0) continue;
    throw InputError(path, lines[3].number, fmt::format("distortion must be 0 in a *.camera file, got {}", value),
                     "undistort the images first");
  }
  const auto size = split_words(lines[8].text);
  if (size.size() != 2) throw InputError(path, lines[8].number, "the image's width and height are wanted", "");
  record.camera.width = parse_size(path, lines[8].number, size[0]);
  record.camera.height = parse_size(path, lines[8].number, size[1]);
  record.lines = {{"fx", lines[0].number},
                  {"cx", lines[0].number},
                  {"fy", lines[1].number},
                  {"cy", lines[1].number},
                  {"image", lines[8].number}};
  return {record};
}

}  // namespace alidade
