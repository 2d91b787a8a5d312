// SPDX-License-Identifier: Apache-2.0
#include "io/line_images.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <string>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/text_lines.h"
#include "io/yaml_nodes.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

constexpr const char* kIndex = "lines.yaml";

double at_least(const Path& path, const YAML::Node& node, const char* name, double least) {
  const double value = yaml_number(path, node);
  if (value >= least) return value;
  throw InputError(path, yaml_line(node), fmt::format("{} must be >= {}, got {}", name, least, value), "");
}

double positive(const Path& path, const YAML::Node& node, const char* name) {
  const double value = yaml_number(path, node);
  if (value > 0) return value;
  throw InputError(path, yaml_line(node), fmt::format("{} must be > 0, got {}", name, value), "");
}

std::string read_code(const Path& path, const YAML::Node& node) {
  const std::string code = yaml_text(path, node);
  const bool is_code = code.find_first_not_of("01") == std::string::npos && code.find('1') != std::string::npos;
  if (is_code) return code;
  throw InputError(path, yaml_line(node),
                   fmt::format("the code must consist of 0 and 1 and be lit once, got '{}'", code),
                   "a row of the recording each, e.g. \"1110110011100\"");
}

std::array<double, 3> read_colour(const Path& path, const YAML::Node& node) {
  const auto shares = yaml_numbers(path, node, 3, "[0.1, 0.2, 1.0]");
  const bool is_light =
      *std::min_element(shares.begin(), shares.end()) >= 0 && *std::max_element(shares.begin(), shares.end()) > 0;
  if (!is_light) throw InputError(path, yaml_line(node), "a colour has shares >= 0, not all 0", "");
  return {shares[0], shares[1], shares[2]};
}

MarkerSign read_marker(const Path& path, const YAML::Node& node) {
  constexpr std::array<std::string_view, 4> kKeys{"id", "code", "phase", "colour"};
  require_yaml_map(path, node, "{id: 1, code: \"1110110011100\"}");
  refuse_unknown_keys(path, node, kKeys);
  MarkerSign sign;
  sign.id = yaml_integer(path, yaml_value(path, node, "id", "the marker"));
  if (const YAML::Node code = node["code"]) sign.code = read_code(path, code);
  if (const YAML::Node phase = node["phase"]) {
    sign.phase = yaml_integer(path, phase);
    const int rows = static_cast<int>(sign.code.size());
    if (*sign.phase < 0 || *sign.phase >= rows) {
      throw InputError(path, yaml_line(phase), fmt::format("the phase must be 0 to {}, got {}", rows - 1, *sign.phase),
                       "");
    }
  }
  if (const YAML::Node colour = node["colour"]) sign.colour = read_colour(path, colour);
  return sign;
}

std::vector<MarkerSign> read_markers(const Path& path, const YAML::Node& list) {
  if (!list.IsSequence() || list.size() == 0) {
    throw InputError(path, yaml_line(list), "a list of markers is wanted here", "e.g. - {id: 1, code: \"110\"}");
  }
  std::vector<MarkerSign> signs;
  for (const YAML::Node& node : list) {
    const MarkerSign sign = read_marker(path, node);
    const bool is_known = std::any_of(signs.begin(), signs.end(), [&](const auto& s) { return s.id == sign.id; });
    if (is_known) throw InputError(path, yaml_line(node), fmt::format("marker {} is listed twice", sign.id), "");
    signs.push_back(sign);
  }
  return signs;
}

LineImageSet read_index(const Path& path) {
  constexpr std::array<std::string_view, 6> kKeys{"rate_hz", "first_time_s", "spot_sigma_px",
                                                  "noise",   "saturation",   "markers"};
  const YAML::Node root = load_yaml(path, read_bytes(path));
  require_yaml_map(path, root, "rate_hz: 250");
  refuse_unknown_keys(path, root, kKeys);
  LineImageSet set;
  set.rate_hz = positive(path, yaml_value(path, root, "rate_hz", "the recording"), "rate_hz");
  if (const YAML::Node first = root["first_time_s"]) {
    const auto time = first.IsScalar() ? parse_seconds(first.Scalar()) : std::nullopt;
    if (!time) throw InputError(path, yaml_line(first), "first_time_s is no time in seconds", "");
    set.first_time = *time;
  }
  if (const YAML::Node width = root["spot_sigma_px"]) set.spot_sigma_px = at_least(path, width, "spot_sigma_px", 0.4);
  if (const YAML::Node noise = root["noise"]) {
    constexpr std::array<std::string_view, 2> kNoise{"read", "shot"};
    require_yaml_map(path, noise, "{read: 7.0, shot: 0.6}");
    refuse_unknown_keys(path, noise, kNoise);
    if (noise["read"]) set.read_noise = at_least(path, noise["read"], "read", 0.0);
    if (noise["shot"]) set.counts_per_electron = at_least(path, noise["shot"], "shot", 0.0);
  }
  if (const YAML::Node full = root["saturation"]) set.saturation = positive(path, full, "saturation");
  set.signs = read_markers(path, yaml_value(path, root, "markers", "the recording"));
  return set;
}

// Detector and part of "detector_3.png" (part −1) or "detector_3_0.png"; empty for other names.
std::optional<std::pair<int, int>> parts_of_name(const std::string& name) {
  constexpr std::string_view kPrefix = "detector_", kSuffix = ".png";
  if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) return std::nullopt;
  const char* at = name.data() + kPrefix.size();
  const char* const end = name.data() + name.size() - kSuffix.size();
  int detector = 0, part = -1;
  auto read = std::from_chars(at, end, detector);
  if (read.ec != std::errc() || detector < 0) return std::nullopt;
  if (read.ptr == end) return std::pair{detector, -1};
  if (*read.ptr != '_') return std::nullopt;
  read = std::from_chars(read.ptr + 1, end, part);
  if (read.ec != std::errc() || read.ptr != end || part < 0) return std::nullopt;
  return std::pair{detector, part};
}

void require_parts(const Path& directory, int detector, const std::map<int, Path>& parts) {
  if (parts.contains(-1) && parts.size() > 1) {
    throw InputError(directory / line_image_name(detector), 0,
                     fmt::format("stands beside parts of detector {}", detector), "keep the whole or the parts");
  }
  int expected = std::min(0, parts.begin()->first);
  for (const auto& [part, path] : parts) {
    if (part != expected++) throw InputError(path, 0, fmt::format("part {} before it is missing", expected - 1), "");
  }
}

std::vector<LineImageFiles> list_images(const Path& directory) {
  std::map<int, std::map<int, Path>> found;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const std::string name = entry.path().filename();
    if (entry.path().extension() != ".png") continue;
    const auto parts = parts_of_name(name);
    if (!parts) throw InputError(entry.path(), 0, "is the image of no detector", "name it detector_ID.png");
    const bool is_new = found[parts->first].emplace(parts->second, entry.path()).second;
    if (!is_new) throw InputError(entry.path(), 0, "is there under two names", "keep one");
  }
  if (found.empty()) throw InputError(directory, 0, "holds no line images", "they are called detector_ID.png");
  std::vector<LineImageFiles> detectors;
  for (const auto& [detector, parts] : found) {
    require_parts(directory, detector, parts);
    LineImageFiles files{detector, {}};
    for (const auto& [part, path] : parts) files.parts.push_back(path);
    detectors.push_back(files);
  }
  return detectors;
}

std::string text_of(const MarkerSign& sign) {
  std::string text = fmt::format("  - {{id: {}, code: \"{}\"", sign.id, sign.code);
  if (sign.phase) text += fmt::format(", phase: {}", *sign.phase);
  if (sign.colour)
    text += fmt::format(", colour: [{}, {}, {}]", (*sign.colour)[0], (*sign.colour)[1], (*sign.colour)[2]);
  return text + "}\n";
}

}  // namespace

LineImageSet read_line_image_set(const Path& directory) {
  if (!std::filesystem::is_directory(directory)) {
    throw InputError(directory, 0, "is no directory", fmt::format("one with {} and images is wanted", kIndex));
  }
  LineImageSet set = read_index(directory / kIndex);
  set.detectors = list_images(directory);
  return set;
}

void write_line_image_set(const Path& directory, const LineImageSet& set) {
  std::string text = fmt::format("# Rows of detector_ID.png are successive exposures.\nrate_hz: {}\nfirst_time_s: {}\n",
                                 set.rate_hz, format_seconds(set.first_time));
  if (set.spot_sigma_px) text += fmt::format("spot_sigma_px: {}\n", *set.spot_sigma_px);
  if (set.read_noise > 0 || set.counts_per_electron > 0) {
    text += fmt::format("noise: {{read: {}, shot: {}}}\n", set.read_noise, set.counts_per_electron);
  }
  if (set.saturation > 0) text += fmt::format("saturation: {}\n", set.saturation);
  text += "markers:\n";
  for (const MarkerSign& sign : set.signs) text += text_of(sign);
  write_file(directory / kIndex, text);
}

Path line_image_name(int detector, std::optional<int> part) {
  return part ? fmt::format("detector_{}_{}.png", detector, *part) : fmt::format("detector_{}.png", detector);
}

}  // namespace alidade
