// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_control.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "capture/v4l2/v4l2_device.h"
#include "core/nearest_name.h"

namespace alidade {
namespace {

std::optional<std::int64_t> parse_integer(std::string_view text) {
  const bool is_negative = text.starts_with('-');
  if (is_negative) text.remove_prefix(1);
  const bool is_hexadecimal = text.starts_with("0x") || text.starts_with("0X");
  if (is_hexadecimal) text.remove_prefix(2);
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, is_hexadecimal ? 16 : 10);
  if (error != std::errc{} || stop != end || text.starts_with('-')) return std::nullopt;
  return is_negative ? -value : value;
}

std::optional<std::int64_t> parse_word(const V4l2Control& control, std::string_view text) {
  const std::string word = v4l2_control_name(text);
  if (control.kind == V4l2ControlKind::Boolean) {
    if (word == "on" || word == "true") return 1;
    if (word == "off" || word == "false") return 0;
  }
  for (const auto& [value, name] : control.entries) {
    if (v4l2_control_name(name) == word) return value;
  }
  return std::nullopt;
}

bool is_taken(const V4l2Control& control, std::int64_t value) {
  if (value < control.least || value > control.most) return false;
  if (control.kind == V4l2ControlKind::Choice)
    return std::any_of(control.entries.begin(), control.entries.end(), [&](const auto& e) { return e.first == value; });
  return control.step <= 1 || (value - control.least) % control.step == 0;
}

std::string what_it_takes(const V4l2Control& control) {
  switch (control.kind) {
    case V4l2ControlKind::Boolean:
      return "it takes on and off";
    case V4l2ControlKind::Choice: {
      std::vector<std::string> entries;
      for (const auto& [value, name] : control.entries) entries.push_back(fmt::format("{} ({})", value, name));
      return fmt::format("it takes {}", fmt::join(entries, ", "));
    }
    default:
      return "it takes " + range_text(control);
  }
}

}  // namespace

std::string v4l2_control_name(std::string_view title) {
  std::string name;
  bool is_between = false;
  for (const char character : title) {
    const auto byte = static_cast<unsigned char>(character);
    if (!std::isalnum(byte)) {
      is_between = !name.empty();
      continue;
    }
    if (is_between) name += '_';
    is_between = false;
    name += static_cast<char>(std::tolower(byte));
  }
  return name;
}

std::int64_t parse_v4l2_value(const std::string& device, const V4l2Control& control, std::string_view text) {
  if (control.kind == V4l2ControlKind::Command) return 1;
  const std::optional<std::int64_t> number = parse_integer(text);
  const std::optional<std::int64_t> value = number ? number : parse_word(control, text);
  if (!value || !is_taken(control, *value))
    throw v4l2_refusal(device, "set " + control.name, fmt::format("'{}' is not one of its values", text),
                       what_it_takes(control));
  return *value;
}

std::string range_text(const V4l2Control& control) {
  if (control.kind != V4l2ControlKind::Integer) return "";
  return fmt::format("{} to {} by {}", control.least, control.most, control.step);
}

const V4l2Control& find_v4l2_control(const std::string& device, std::span<const V4l2Control> controls,
                                     std::string_view name) {
  const auto found =
      std::find_if(controls.begin(), controls.end(), [&](const V4l2Control& control) { return control.name == name; });
  if (found != controls.end()) return *found;
  std::vector<std::string_view> names;
  for (const V4l2Control& control : controls) names.push_back(control.name);
  throw v4l2_refusal(device, "set " + std::string(name), "the camera has no such control",
                     names.empty() ? "it has none at all" : suggest_name(name, names));
}

}  // namespace alidade
