// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <span>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/camera_records.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

// A model of COLMAP's, and where its parameters go. Source: colmap, src/base/camera_models.h.
struct ColmapModel {
  std::string_view name;
  std::size_t parameters;
};
constexpr std::array<ColmapModel, 7> kColmapModels{{{"SIMPLE_PINHOLE", 3},
                                                    {"PINHOLE", 4},
                                                    {"SIMPLE_RADIAL", 4},
                                                    {"RADIAL", 5},
                                                    {"OPENCV", 8},
                                                    {"FULL_OPENCV", 12},
                                                    {"OPENCV_FISHEYE", 8}}};

const ColmapModel& find_model(const Path& path, int line, std::string_view name) {
  std::vector<std::string_view> known;
  for (const ColmapModel& model : kColmapModels) {
    if (model.name == name) return model;
    known.push_back(model.name);
  }
  throw InputError(path, line, fmt::format("COLMAP's camera model '{}' is not supported", name),
                   fmt::format("supported are {}", fmt::join(known, ", ")));
}

Camera colmap_camera(const Path& path, int line, std::string_view model, const std::vector<double>& p) {
  const bool one_focal_length = model.starts_with("SIMPLE") || model == "RADIAL";
  const std::size_t centre = one_focal_length ? 1 : 2;
  Camera c;
  c.fx = p[0];
  c.fy = one_focal_length ? p[0] : p[1];
  c.cx = p[centre] - 0.5;  // COLMAP's origin is the corner of the top-left pixel, ours its centre
  c.cy = p[centre + 1] - 0.5;
  const auto k = std::span(p).subspan(centre + 2);
  if (model == "OPENCV_FISHEYE") {
    c.distortion = fisheye_from(path, line, k);
  } else {
    c.distortion = distortion_from(path, line, k);
  }
  return c;
}

std::string_view model_of(const Distortion& distortion) {
  if (std::holds_alternative<Fisheye>(distortion)) return "OPENCV_FISHEYE";
  if (is_pinhole(distortion)) return "PINHOLE";
  return coefficients(distortion).tail<4>().isZero(0) ? "OPENCV" : "FULL_OPENCV";
}

}  // namespace

CameraRecords parse_colmap_cameras(const Path& path, const std::vector<TextLine>& lines) {
  CameraRecords records;
  for (const TextLine& line : lines) {
    const auto words = split_words(line.text);
    if (words.size() < 4) throw InputError(path, line.number, "CAMERA_ID MODEL WIDTH HEIGHT PARAMS... are wanted", "");
    const ColmapModel& model = find_model(path, line.number, words[1]);
    if (words.size() != 4 + model.parameters) {
      throw InputError(path, line.number,
                       fmt::format("{} has {} parameters, got {}", model.name, model.parameters, words.size() - 4), "");
    }
    std::vector<double> parameters;
    for (std::size_t i = 4; i < words.size(); ++i) parameters.push_back(parse_number(path, line.number, words[i]));
    CameraRecord record;
    record.name = words[0];
    record.line = line.number;
    record.camera = colmap_camera(path, line.number, model.name, parameters);
    record.camera.width = parse_size(path, line.number, words[2]);
    record.camera.height = parse_size(path, line.number, words[3]);
    records.push_back(record);
  }
  return records;
}

std::string format_colmap_cameras(std::span<const Camera> cameras) {
  std::string text = "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n";
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera& c = cameras[i];
    const std::string_view model = model_of(c.distortion);
    text += fmt::format("{} {} {} {} {} {} {} {}", i + 1, model, c.width, c.height, c.fx, c.fy, c.cx + 0.5, c.cy + 0.5);
    const DistortionCoefficients k = coefficients(c.distortion);
    const Eigen::Index count = model == "PINHOLE" ? 0 : model == "OPENCV" ? 4 : k.size();
    for (Eigen::Index j = 0; j < count; ++j) text += fmt::format(" {}", k[j]);
    text += "\n";
  }
  return text;
}

}  // namespace alidade
