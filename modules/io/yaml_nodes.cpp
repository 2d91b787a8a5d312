// SPDX-License-Identifier: Apache-2.0
#include "io/yaml_nodes.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "io/text_lines.h"

namespace alidade {

using Path = std::filesystem::path;

namespace {

void append_numbers(const Path& path, const YAML::Node& node, std::vector<double>& numbers) {
  if (node.IsMap() && node["data"]) return append_numbers(path, node["data"], numbers);
  if (!node.IsSequence()) return numbers.push_back(yaml_number(path, node));
  for (const YAML::Node& item : node) append_numbers(path, item, numbers);
}

}  // namespace

YAML::Node load_yaml(const Path& path, const std::string& text) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& e) {
    throw InputError(path, e.mark.line + 1, "damaged YAML: " + e.msg, "correct the line or write the file again");
  }
}

int yaml_line(const YAML::Node& node) {
  return node.Mark().line + 1;
}

double yaml_number(const Path& path, const YAML::Node& node) {
  if (!node.IsScalar()) throw InputError(path, yaml_line(node), "a number is wanted here", "");
  return parse_number(path, yaml_line(node), node.Scalar());
}

int yaml_integer(const Path& path, const YAML::Node& node) {
  if (!node.IsScalar()) throw InputError(path, yaml_line(node), "a whole number is wanted here", "");
  const long long value = parse_integer(path, yaml_line(node), node.Scalar());
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    throw InputError(path, yaml_line(node), fmt::format("{} is out of the range of whole numbers", value), "");
  }
  return static_cast<int>(value);
}

std::vector<double> yaml_numbers(const Path& path, const YAML::Node& node, std::size_t count, const char* example) {
  if (!node.IsSequence() || node.size() != count) {
    throw InputError(path, yaml_line(node), fmt::format("a list of {} numbers is wanted here", count),
                     fmt::format("e.g. {}", example));
  }
  std::vector<double> numbers;
  for (const YAML::Node& item : node) numbers.push_back(yaml_number(path, item));
  return numbers;
}

std::vector<double> yaml_all_numbers(const Path& path, const YAML::Node& node) {
  std::vector<double> numbers;
  if (!node.IsNull()) append_numbers(path, node, numbers);
  return numbers;
}

std::string yaml_text(const Path& path, const YAML::Node& node) {
  if (node.IsScalar() && !node.Scalar().empty()) return node.Scalar();
  throw InputError(path, yaml_line(node), "a name is wanted here", "");
}

std::string yaml_choice(const Path& path, const YAML::Node& node, const char* what,
                        std::span<const std::string_view> known) {
  const std::string word = node.IsScalar() ? node.Scalar() : "";
  if (std::find(known.begin(), known.end(), word) != known.end()) return word;
  throw InputError(path, yaml_line(node), fmt::format("unknown {} '{}'", what, word), suggest_name(word, known));
}

YAML::Node yaml_value(const Path& path, const YAML::Node& map, const char* key, std::string_view owner) {
  const YAML::Node value = map[key];
  if (!value) throw InputError(path, yaml_line(map), fmt::format("{} has no '{}'", owner, key), "");
  return value;
}

void require_yaml_map(const Path& path, const YAML::Node& node, const char* example) {
  if (node.IsMap()) return;
  throw InputError(path, yaml_line(node), "names with values are wanted here", fmt::format("e.g. {}", example));
}

void refuse_unknown_keys(const Path& path, const YAML::Node& map, std::span<const std::string_view> known) {
  for (const auto& entry : map) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw InputError(path, yaml_line(entry.first), fmt::format("unknown key '{}'", key), suggest_name(key, known));
  }
}

}  // namespace alidade
