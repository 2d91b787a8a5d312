// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace alidade {

/// Binds the fields of option structs once, to keys of a YAML file and to flags alike. A name with dots is a key in
/// sections and a flag with dashes: "features.max_count" is `features: {max_count: ...}` and --features-max-count.
/// The bound structs must outlive this object. Precedence: flag, then file, then the struct's default.
class OptionFields {
 public:
  /// `unit` is empty for counts, switches and names. The fields of a section are added together; a second field of the
  /// same name or a section in two places throws std::invalid_argument.
  void add(std::string name, double& value, std::string unit, std::string help);
  void add(std::string name, int& value, std::string unit, std::string help);
  void add(std::string name, unsigned& value, std::string unit, std::string help);
  void add(std::string name, bool& value, std::string unit, std::string help);
  /// A switch that stands at "auto" until somebody sets it.
  void add(std::string name, std::optional<bool>& value, std::string unit, std::string help);
  void add(std::string name, std::string& value, std::string unit, std::string help);

  /// A value out of a closed set, by name: add_choice("refine", refine, {{"none", Refine::None}, ...}, "...").
  template <class E>
  void add_choice(std::string name, E& value, std::vector<std::pair<std::string, E>> choices, std::string help);

  /// A check over the bound structs, called by validate(): the module's own validate(options), which throws
  /// std::invalid_argument naming field, value and bound.
  void add_check(std::function<void()> check) { checks_.push_back(std::move(check)); }

  /// Adds a flag per field; a switch becomes --name and --no-name.
  void add_flags(CLI::App& app);

  /// Sets the fields named in a YAML file, save those set by a flag. Throws InputError with path:line on unknown keys
  /// (naming the nearest known one), repeated keys, values of the wrong kind, and a file that is not YAML.
  void read(const std::filesystem::path& path);

  /// Runs the checks; std::invalid_argument becomes InputError on `source` (the config file or "options").
  void validate(const std::string& source) const;

  /// All fields with their present values as YAML, unit and help as comments; read() gives the same values back.
  std::string to_yaml() const;

 private:
  struct Field {
    std::string name;
    std::string unit;
    std::string help;
    std::function<void(const std::string&)> parse;  ///< throws std::invalid_argument "must be ..., got ..."
    std::function<std::string()> print;
    bool is_switch = false;
    bool is_text = false;  ///< quoted in YAML
    const CLI::Option* flag = nullptr;
    const CLI::Option* no_flag = nullptr;  ///< --no-name of a switch
  };

  void add_field(Field field);
  void add_named(std::string name, std::vector<std::string> names, std::string help, std::function<void(int)> set,
                 std::function<int()> get);
  void set_from_file(const std::string& path, int line, const std::string& name, const std::string& text);
  std::vector<std::string_view> names() const;

  std::deque<Field> fields_;  // stable addresses: the flags refer to them
  std::vector<std::function<void()>> checks_;
};

template <class E>
void OptionFields::add_choice(std::string name, E& value, std::vector<std::pair<std::string, E>> choices,
                              std::string help) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  auto get = [&value, choices] {
    for (std::size_t i = 0; i < choices.size(); ++i)
      if (choices[i].second == value) return static_cast<int>(i);
    return -1;
  };
  auto set = [&value, choices](int index) { value = choices[static_cast<std::size_t>(index)].second; };
  add_named(std::move(name), std::move(names), std::move(help), set, get);
}

}  // namespace alidade
