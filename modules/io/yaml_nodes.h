// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <yaml-cpp/yaml.h>

// What every reader of a YAML (or JSON, which YAML contains) file asks of its nodes. All throw InputError with the
// line.
namespace alidade {

/// The root of the document in `text`. Throws where it is damaged.
YAML::Node load_yaml(const std::filesystem::path& path, const std::string& text);

/// Line of a node, from 1.
int yaml_line(const YAML::Node& node);

/// A finite number.
double yaml_number(const std::filesystem::path& path, const YAML::Node& node);

/// A whole number that fits an int.
int yaml_integer(const std::filesystem::path& path, const YAML::Node& node);

/// Exactly `count` finite numbers in a list; `example` goes into the message.
std::vector<double> yaml_numbers(const std::filesystem::path& path, const YAML::Node& node, std::size_t count,
                                 const char* example);

/// All numbers in a scalar, a list, a list of lists, or the `data` of a matrix, in order; none of a null.
std::vector<double> yaml_all_numbers(const std::filesystem::path& path, const YAML::Node& node);

/// A word or text that is not empty.
std::string yaml_text(const std::filesystem::path& path, const YAML::Node& node);

/// One of the known words; the nearest is named where it is none: "unknown model 'pinhol'; did you mean 'pinhole'?".
std::string yaml_choice(const std::filesystem::path& path, const YAML::Node& node, const char* what,
                        std::span<const std::string_view> known);

/// The value of `key`. Throws where the map has none: "OWNER has no 'KEY'".
YAML::Node yaml_value(const std::filesystem::path& path, const YAML::Node& map, const char* key,
                      std::string_view owner);

/// Throws where `node` is no map; `example` goes into the message.
void require_yaml_map(const std::filesystem::path& path, const YAML::Node& node, const char* example);

/// Throws for the first key of `map` that is not known, naming the nearest that is.
void refuse_unknown_keys(const std::filesystem::path& path, const YAML::Node& map,
                         std::span<const std::string_view> known);

}  // namespace alidade
