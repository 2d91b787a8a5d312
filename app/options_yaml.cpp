// SPDX-License-Identifier: Apache-2.0
#include "app/options_yaml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "core/errors.h"
#include "core/nearest_name.h"

namespace alidade {
namespace {

template <class T>
T parse_number(const std::string& text, std::string_view kind) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool whole = error == std::errc{} && stop == end;
  if (!whole || !std::isfinite(static_cast<double>(value)))
    throw std::invalid_argument(fmt::format("must be {}, got '{}'", kind, text));
  return value;
}

bool parse_switch(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  throw std::invalid_argument(fmt::format("must be true or false, got '{}'", text));
}

std::string flag_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '.' || c == '_'; }, '-');
  return name;
}

std::string section_of(const std::string& name) {
  const auto dot = name.rfind('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

// JSON strings are YAML strings; only these two need an escape in the values that a flag can carry on one line.
std::string quoted(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '"' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return '"' + escaped + '"';
}

YAML::Node load(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path, 0, "cannot be opened", "give --config an existing YAML file");
  try {
    return YAML::Load(file);
  } catch (const YAML::Exception& error) {
    throw InputError(path, error.mark.line + 1, fmt::format("not YAML: {}", error.msg), "");
  }
}

struct Entry {
  std::string name;  // with dots
  std::string text;
  int line;
};

// The scalars of nested maps in the order of the file.
void collect(const std::string& path, const YAML::Node& node, const std::string& prefix, std::vector<Entry>& entries) {
  std::set<std::string> seen;
  for (const auto& item : node) {
    const int line = item.first.Mark().line + 1;
    if (!item.first.IsScalar()) throw InputError(path, line, "a key must be a plain name", "");
    const std::string name = prefix + item.first.Scalar();
    if (!seen.insert(name).second) throw InputError(path, line, fmt::format("key '{}' stands twice", name), "keep one");
    if (item.second.IsMap()) {
      collect(path, item.second, name + ".", entries);
    } else {
      if (!item.second.IsScalar())
        throw InputError(path, line, fmt::format("key '{}' must hold a single value", name), "");
      entries.push_back({name, item.second.Scalar(), line});
    }
  }
}

}  // namespace

void OptionFields::add_field(Field field) {
  const std::string section = section_of(field.name);
  for (const Field& other : fields_) {
    if (other.name == field.name) throw std::invalid_argument("two option fields are named " + field.name);
    if (section_of(other.name) == section && !section.empty() && !fields_.back().name.starts_with(section + "."))
      throw std::invalid_argument("option section is added in two places: " + section);
  }
  fields_.push_back(std::move(field));
}

void OptionFields::add(std::string name, double& value, std::string unit, std::string help) {
  add_field({.name = std::move(name),
             .unit = std::move(unit),
             .help = std::move(help),
             .parse = [&value](const std::string& text) { value = parse_number<double>(text, "a finite number"); },
             .print = [&value] { return fmt::format("{}", value); }});
}

void OptionFields::add(std::string name, int& value, std::string unit, std::string help) {
  add_field({.name = std::move(name),
             .unit = std::move(unit),
             .help = std::move(help),
             .parse = [&value](const std::string& text) { value = parse_number<int>(text, "a whole number"); },
             .print = [&value] { return fmt::format("{}", value); }});
}

void OptionFields::add(std::string name, unsigned& value, std::string unit, std::string help) {
  const auto parse = [&value](const std::string& text) {
    value = parse_number<unsigned>(text, "a whole number from 0 on");
  };
  add_field(
      {.name = std::move(name), .unit = std::move(unit), .help = std::move(help), .parse = parse, .print = [&value] {
         return fmt::format("{}", value);
       }});
}

void OptionFields::add(std::string name, bool& value, std::string unit, std::string help) {
  add_field({.name = std::move(name),
             .unit = std::move(unit),
             .help = std::move(help),
             .parse = [&value](const std::string& text) { value = parse_switch(text); },
             .print = [&value] { return value ? "true" : "false"; },
             .is_switch = true});
}

void OptionFields::add(std::string name, std::optional<bool>& value, std::string unit, std::string help) {
  const auto parse = [&value](const std::string& text) {
    value = text == "auto" ? std::nullopt : std::optional(parse_switch(text));
  };
  add_field({.name = std::move(name),
             .unit = std::move(unit),
             .help = std::move(help),
             .parse = parse,
             .print = [&value] { return !value   ? "auto"
                                        : *value ? "true"
                                                 : "false"; },
             .is_switch = true});
}

void OptionFields::add(std::string name, std::string& value, std::string unit, std::string help) {
  add_field({.name = std::move(name),
             .unit = std::move(unit),
             .help = std::move(help),
             .parse = [&value](const std::string& text) { value = text; },
             .print = [&value] { return value; },
             .is_text = true});
}

void OptionFields::add_named(std::string name, std::vector<std::string> names, std::string help,
                             std::function<void(int)> set, std::function<int()> get) {
  const auto parse = [names, set](const std::string& text) {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
      throw std::invalid_argument(fmt::format("must be one of {}, got '{}'", fmt::join(names, ", "), text));
    set(static_cast<int>(found - names.begin()));
  };
  add_field({.name = std::move(name),
             .unit = fmt::format("{}", fmt::join(names, "|")),
             .help = std::move(help),
             .parse = parse,
             .print = [names, get] { return names.at(static_cast<std::size_t>(get())); }});
}

void OptionFields::add_flags(CLI::App& app) {
  for (Field& field : fields_) {
    const std::string name = flag_name(field.name);
    if (field.is_switch) {
      field.flag = app.add_flag_callback(
          "--" + name, [&field] { field.parse("true"); }, field.help);
      field.no_flag = app.add_flag_callback(
          "--no-" + name, [&field] { field.parse("false"); }, "the opposite");
      continue;
    }
    const auto set = [&field, name](const std::string& text) {
      try {
        field.parse(text);
      } catch (const std::invalid_argument& error) {
        throw CLI::ValidationError("--" + name, error.what());
      }
    };
    const std::string type = field.unit.empty() ? "VALUE" : field.unit;
    field.flag =
        app.add_option_function<std::string>("--" + name, set, field.help)->type_name(type)->default_str(field.print());
  }
}

std::vector<std::string_view> OptionFields::names() const {
  std::vector<std::string_view> names;
  for (const Field& field : fields_) names.push_back(field.name);
  return names;
}

void OptionFields::set_from_file(const std::string& path, int line, const std::string& name, const std::string& text) {
  const auto field = std::find_if(fields_.begin(), fields_.end(), [&](const Field& f) { return f.name == name; });
  if (field == fields_.end())
    throw InputError(path, line, fmt::format("unknown key '{}'", name), suggest_name(name, names()));
  try {
    const bool flagged = (field->flag && field->flag->count() > 0) || (field->no_flag && field->no_flag->count() > 0);
    const std::string kept = field->print();
    field->parse(text);
    if (flagged) field->parse(kept);  // the flag wins, yet a bad line is still told
  } catch (const std::invalid_argument& error) {
    throw InputError(path, line, fmt::format("key '{}' {}", name, error.what()), "");
  }
}

void OptionFields::read(const std::filesystem::path& path) {
  const YAML::Node root = load(path.string());
  if (root.IsNull()) return;
  if (!root.IsMap()) throw InputError(path.string(), 1, "must hold keys with values", "e.g. 'seed: 1'");
  std::vector<Entry> entries;
  collect(path.string(), root, "", entries);
  for (const Entry& entry : entries) set_from_file(path.string(), entry.line, entry.name, entry.text);
}

void OptionFields::validate(const std::string& source) const {
  try {
    for (const auto& check : checks_) check();
  } catch (const std::invalid_argument& error) {
    throw InputError(source, 0, error.what(), "");
  }
}

std::string OptionFields::to_yaml() const {
  std::string yaml;
  std::vector<std::string> open;  // the sections we are in
  for (const Field& field : fields_) {
    std::vector<std::string> sections;
    std::size_t start = 0;
    for (std::size_t dot; (dot = field.name.find('.', start)) != std::string::npos; start = dot + 1)
      sections.push_back(field.name.substr(start, dot - start));
    const auto fork = std::mismatch(sections.begin(), sections.end(), open.begin(), open.end()).first;
    for (auto section = fork; section != sections.end(); ++section)
      yaml += fmt::format("{:{}}{}:\n", "", 2 * (section - sections.begin()), *section);
    const std::string value = field.is_text ? quoted(field.print()) : field.print();
    const std::string unit = field.unit.empty() ? "" : fmt::format("[{}] ", field.unit);
    yaml += fmt::format("{:{}}{}: {}  # {}{}\n", "", 2 * sections.size(), field.name.substr(start), value, unit,
                        field.help);
    open = std::move(sections);
  }
  return yaml;
}

}  // namespace alidade
