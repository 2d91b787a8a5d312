// SPDX-License-Identifier: Apache-2.0
#include "io/map_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/ply_reader.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

static_assert(std::endian::native == std::endian::little, "binary values are copied as they are");

constexpr const char* kHeader = R"(ply
format binary_little_endian 1.0
comment points of an Alidade map; x y z: world frame, m (or the map's own unit where its scale is not known)
comment cov_*: covariance of (x, y, z), world frame, m^2, upper triangle; all 0: not known
comment descriptor: SIFT, 128 values of 0..255, or none
element vertex {}
property double x
property double y
property double z
property uchar red
property uchar green
property uchar blue
property double cov_xx
property double cov_xy
property double cov_xz
property double cov_yy
property double cov_yz
property double cov_zz
property list uchar uchar descriptor
end_header
)";

void append(std::string& bytes, double value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
void append(std::string& bytes, std::uint8_t value) {
  bytes += static_cast<char>(value);
}

std::string point_bytes(const MapPoint& point) {
  std::string bytes;
  for (int i = 0; i < 3; ++i) append(bytes, point.p_world[i]);
  for (const std::uint8_t colour : point.rgb) append(bytes, colour);
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) append(bytes, point.covariance_world(i, j));
  }
  const bool described = point.descriptor != Descriptor{};
  append(bytes, static_cast<std::uint8_t>(described ? point.descriptor.size() : 0));
  if (described) bytes.append(reinterpret_cast<const char*>(point.descriptor.data()), point.descriptor.size());
  return bytes;
}

/// Where the values of a point stand in a row of the vertex element.
class VertexColumns {
 public:
  explicit VertexColumns(const PlyElement& element) : element_(element) {}

  bool has(std::string_view name) const { return find(name).has_value(); }

  double value(const PlyRow& row, std::string_view name, double otherwise) const {
    const auto column = find(name);
    return column && !row[*column].empty() ? row[*column].front() : otherwise;
  }

  std::uint8_t colour(const PlyRow& row, std::string_view name, std::uint8_t otherwise) const {
    const auto column = find(name);
    if (!column || row[*column].empty()) return otherwise;
    const PlyType type = element_.properties[*column].type;
    const bool fraction = type == PlyType::Float32 || type == PlyType::Float64;  // 0..1 instead of 0..255
    const double value = row[*column].front() * (fraction ? 255.0 : 1.0);
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
  }

  const std::vector<double>* list(const PlyRow& row, std::string_view name) const {
    const auto column = find(name);
    return column ? &row[*column] : nullptr;
  }

 private:
  std::optional<std::size_t> find(std::string_view name) const {
    for (std::size_t i = 0; i < element_.properties.size(); ++i) {
      if (element_.properties[i].name == name) return i;
    }
    return std::nullopt;
  }

  const PlyElement& element_;
};

MapPoint point_from(const VertexColumns& columns, const PlyRow& row) {
  constexpr const char* kPosition[] = {"x", "y", "z"};
  constexpr const char* kColour[] = {"red", "green", "blue"};
  constexpr const char* kCovariance[3][3] = {
      {"cov_xx", "cov_xy", "cov_xz"}, {"cov_xy", "cov_yy", "cov_yz"}, {"cov_xz", "cov_yz", "cov_zz"}};
  MapPoint point;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    point.p_world[i] = columns.value(row, kPosition[i], 0.0);
    point.rgb[k] = columns.colour(row, kColour[i], point.rgb[k]);
    for (int j = 0; j < 3; ++j) point.covariance_world(i, j) = columns.value(row, kCovariance[i][j], 0.0);
  }
  return point;
}

void check(const std::filesystem::path& path, std::size_t index, const MapPoint& point) {
  const bool finite = point.p_world.allFinite() && point.covariance_world.allFinite();
  if (!finite) throw InputError(path, 0, fmt::format("vertex {} is not finite", index), "remove it");
}

}  // namespace

void write_map_ply(const std::filesystem::path& path, const PointMap& map) {
  AtomicFile file(path);
  file.write(fmt::format(fmt::runtime(kHeader), map.points.size()));
  for (const MapPoint& point : map.points) file.write(point_bytes(point));
  file.commit();
}

PointMap read_map_ply(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path);
  PlyReader reader(path, bytes);
  for (const PlyElement& element : reader.elements()) {
    if (element.name != "vertex") {
      for (std::size_t i = 0; i < element.count; ++i) reader.read_row(element);
      continue;
    }
    const VertexColumns columns(element);
    for (const char* name : {"x", "y", "z"}) {
      if (!columns.has(name)) throw InputError(path, 0, fmt::format("its vertices have no '{}'", name), "");
    }
    PointMap map;
    map.points.reserve(std::min(element.count, bytes.size()));
    for (std::size_t i = 0; i < element.count; ++i) {
      const PlyRow row = reader.read_row(element);
      map.points.push_back(point_from(columns, row));
      check(path, i, map.points.back());
      const std::vector<double>* descriptor = columns.list(row, "descriptor");
      if (!descriptor || descriptor->empty()) continue;
      if (descriptor->size() != Descriptor{}.size()) {
        throw InputError(path, 0, fmt::format("vertex {} has a descriptor of {} values", i, descriptor->size()),
                         "SIFT has 128");
      }
      std::transform(descriptor->begin(), descriptor->end(), map.points.back().descriptor.begin(),
                     [](double value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)); });
    }
    return map;
  }
  throw InputError(path, 0, "holds no vertices", "an element 'vertex' is wanted");
}

}  // namespace alidade
