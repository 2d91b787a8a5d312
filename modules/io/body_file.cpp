// SPDX-License-Identifier: Apache-2.0
#include "io/body_file.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/table.h"

namespace alidade {
namespace {

RigidBody& body_named(std::vector<RigidBody>& bodies, const std::string& name) {
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const auto& b) { return b.name == name; });
  return found != bodies.end() ? *found : bodies.emplace_back(RigidBody{name, {}});
}

int marker_id(const Table& table, std::size_t row, std::size_t column) {
  const std::int64_t id = table.integer(row, column);
  if (id >= std::numeric_limits<int>::min() && id <= std::numeric_limits<int>::max()) return static_cast<int>(id);
  throw table.error(row, fmt::format("{} is too large for a marker's id", id));
}

}  // namespace

std::vector<RigidBody> read_bodies(const std::filesystem::path& path) {
  const Table table = read_table(path);
  const std::size_t marker = table.column("marker");
  const std::array<std::size_t, 3> xyz{table.column("x_m"), table.column("y_m"), table.column("z_m")};
  const bool has_names = table.has_column("body");
  if (table.row_count() == 0) throw InputError(path, 0, "holds no markers", "give each marker a row");
  std::vector<RigidBody> bodies;
  std::map<int, std::string> body_of;  // whose a marker's id is
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const std::string name = has_names ? table.text(row, table.column("body")) : path.stem().string();
    if (name.empty()) throw table.error(row, "the body has no name", "leave out the column 'body' if there is but one");
    BodyMarker m;
    m.id = marker_id(table, row, marker);
    for (std::size_t i = 0; i < 3; ++i) m.p_body[static_cast<Eigen::Index>(i)] = table.number(row, xyz[i]);
    if (!body_of.emplace(m.id, name).second) {
      throw table.error(row, fmt::format("marker {} is there twice", m.id), "ids are unique among all bodies");
    }
    body_named(bodies, name).markers.push_back(m);
  }
  return bodies;
}

void write_bodies(const std::filesystem::path& path, std::span<const RigidBody> bodies) {
  constexpr std::array<std::string_view, 5> kColumns{"body", "marker", "x_m", "y_m", "z_m"};
  TableWriter writer(path, kColumns);
  for (const RigidBody& body : bodies) {
    for (const BodyMarker& m : body.markers) {
      writer.write_row({body.name, std::int64_t{m.id}, m.p_body.x(), m.p_body.y(), m.p_body.z()});
    }
  }
  writer.commit();
}

}  // namespace alidade
