// SPDX-License-Identifier: Apache-2.0
#include "app/camera_listing_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

std::string text_of(cv::Size size) {
  return fmt::format("{}x{}", size.width, size.height);
}

std::string text_of(const ListedSize& listed) {
  const std::string size =
      listed.least ? fmt::format("{} to {}", text_of(*listed.least), text_of(listed.size)) : text_of(listed.size);
  if (listed.fps_hz.empty()) return size;
  std::vector<std::string> rates;
  for (const double rate_hz : listed.fps_hz) rates.push_back(fmt::format("{:.6g}", rate_hz));
  return fmt::format("{} at {} Hz", size, fmt::join(rates, ", "));
}

std::vector<std::string> lines_of(const ListedFormat& format, bool is_whole) {
  std::string head = "  " + format.name;
  if (is_whole && !format.description.empty()) head += " (" + format.description + ")";
  if (!format.is_readable) head += ", not one that alidade reads";
  std::vector<std::string> lines;
  if (!is_whole && !format.sizes.empty()) {  // the first size and how many more
    const std::size_t more = format.sizes.size() - 1;
    return {fmt::format("{}: {}{}", head, text_of(format.sizes.front()),
                        more ? fmt::format(", and {} more size{}", more, more > 1 ? "s" : "") : "")};
  }
  lines.push_back(head);
  for (const ListedSize& size : format.sizes) lines.push_back("    " + text_of(size));
  return lines;
}

std::string line_of(const ListedControl& control) {
  std::string line = fmt::format("    {} = {}", control.name, control.value.empty() ? "?" : control.value);
  if (!control.unit.empty()) line += " " + control.unit;
  line += fmt::format("  ({}{}{})", control.kind, control.range.empty() ? "" : ", " + control.range,
                      control.is_writable ? "" : ", read only");
  if (!control.choices.empty()) line += fmt::format(": {}", fmt::join(control.choices, ", "));
  return line;
}

nlohmann::json to_json(const ListedSize& listed) {
  nlohmann::json json{{"width_px", listed.size.width}, {"height_px", listed.size.height}, {"rates_hz", listed.fps_hz}};
  if (listed.least) json["least_px"] = {listed.least->width, listed.least->height};
  return json;
}

nlohmann::json to_json(const ListedFormat& format) {
  nlohmann::json sizes = nlohmann::json::array();
  for (const ListedSize& size : format.sizes) sizes.push_back(to_json(size));
  return {{"name", format.name},
          {"description", format.description},
          {"is_readable", format.is_readable},
          {"sizes", std::move(sizes)}};
}

nlohmann::json to_json(const ListedControl& control) {
  return {{"name", control.name},      {"kind", control.kind}, {"value", control.value},
          {"range", control.range},    {"unit", control.unit}, {"is_writable", control.is_writable},
          {"choices", control.choices}};
}

}  // namespace

std::vector<std::string> lines_of(const ListedCamera& camera, bool is_whole) {
  std::string head = camera.source;
  if (!camera.model.empty()) head += "  " + camera.model;
  if (!camera.serial.empty()) head += ", serial " + camera.serial;
  if (!camera.driver.empty()) head += ", by " + camera.driver;
  std::vector<std::string> lines{head};
  for (const std::string& alias : camera.aliases) lines.push_back("  also " + alias);
  if (!camera.trouble.empty()) lines.push_back("  cannot be asked: " + camera.trouble);
  for (const ListedFormat& format : camera.formats) {
    for (std::string& line : lines_of(format, is_whole)) lines.push_back(std::move(line));
  }
  if (!is_whole || camera.controls.empty()) return lines;
  lines.emplace_back("  for --set:");
  for (const ListedControl& control : camera.controls) lines.push_back(line_of(control));
  return lines;
}

nlohmann::json to_json(const ListedCamera& camera) {
  nlohmann::json formats = nlohmann::json::array(), controls = nlohmann::json::array();
  for (const ListedFormat& format : camera.formats) formats.push_back(to_json(format));
  for (const ListedControl& control : camera.controls) controls.push_back(to_json(control));
  nlohmann::json json{{"source", camera.source},        {"aliases", camera.aliases}, {"model", camera.model},
                      {"serial", camera.serial},        {"driver", camera.driver},   {"formats", std::move(formats)},
                      {"controls", std::move(controls)}};
  if (!camera.trouble.empty()) json["trouble"] = camera.trouble;
  return json;
}

}  // namespace alidade
