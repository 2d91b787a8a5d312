// SPDX-License-Identifier: Apache-2.0
#include "io/ply_reader.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

static_assert(std::endian::native == std::endian::little, "binary values are copied as they are");

std::optional<PlyType> type_named(std::string_view name) {
  constexpr std::pair<std::string_view, PlyType> kNames[] = {
      {"char", PlyType::Int8},      {"int8", PlyType::Int8},       {"uchar", PlyType::UInt8},
      {"uint8", PlyType::UInt8},    {"short", PlyType::Int16},     {"int16", PlyType::Int16},
      {"ushort", PlyType::UInt16},  {"uint16", PlyType::UInt16},   {"int", PlyType::Int32},
      {"int32", PlyType::Int32},    {"uint", PlyType::UInt32},     {"uint32", PlyType::UInt32},
      {"float", PlyType::Float32},  {"float32", PlyType::Float32}, {"double", PlyType::Float64},
      {"float64", PlyType::Float64}};
  for (const auto& [known, type] : kNames) {
    if (known == name) return type;
  }
  return std::nullopt;
}

template <typename T>
double take(std::string_view& bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return static_cast<double>(value);
}

std::size_t size_of(PlyType type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

double take(std::string_view& bytes, PlyType type) {
  switch (type) {
    case PlyType::Int8:
      return take<std::int8_t>(bytes);
    case PlyType::UInt8:
      return take<std::uint8_t>(bytes);
    case PlyType::Int16:
      return take<std::int16_t>(bytes);
    case PlyType::UInt16:
      return take<std::uint16_t>(bytes);
    case PlyType::Int32:
      return take<std::int32_t>(bytes);
    case PlyType::UInt32:
      return take<std::uint32_t>(bytes);
    case PlyType::Float32:
      return take<float>(bytes);
    case PlyType::Float64:
      return take<double>(bytes);
  }
  return 0;
}

}  // namespace

PlyReader::PlyReader(std::filesystem::path path, std::string_view bytes) : path_(std::move(path)), rest_(bytes) {
  if (!bytes.starts_with("ply\n") && !bytes.starts_with("ply\r\n")) {
    throw InputError(path_, 0, "is no PLY file", "its first line must be 'ply'");
  }
  read_header();
}

void PlyReader::read_header() {
  while (true) {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) throw InputError(path_, 0, "is cut off in its header", "copy the file again");
    const std::string_view line = trim(rest_.substr(0, end));
    rest_.remove_prefix(end + 1);
    ++line_;
    if (line == "end_header") return;
    const auto words = split_words(line);
    if (!words.empty() && words[0] != "ply" && words[0] != "comment" && words[0] != "obj_info") read_header_line(words);
  }
}

void PlyReader::read_header_line(const std::vector<std::string_view>& words) {
  if (words[0] == "format" && words.size() == 3) {
    ascii_ = words[1] == "ascii";
    if (!ascii_ && words[1] != "binary_little_endian") {
      throw InputError(path_, line_, fmt::format("format '{}' is not supported", words[1]),
                       "write it as ascii or binary_little_endian");
    }
  } else if (words[0] == "element" && words.size() == 3) {
    const long long count = parse_integer(path_, line_, words[2]);
    if (count < 0) throw InputError(path_, line_, "an element cannot have fewer than 0 rows", "");
    elements_.push_back({std::string(words[1]), static_cast<std::size_t>(count), {}});
  } else if (words[0] == "property" && !elements_.empty() && words.size() == (words[1] == "list" ? 5u : 3u)) {
    const bool is_list = words.size() == 5;
    const auto type = type_named(words[words.size() - 2]);
    const auto count_type = type_named(is_list ? words[2] : "uchar");
    if (!type || !count_type) throw InputError(path_, line_, "the type of this property is not known", "");
    elements_.back().properties.push_back({std::string(words.back()), *type, is_list, *count_type});
  } else {
    throw InputError(path_, line_, fmt::format("'{}' is not understood here", words[0]), "");
  }
}

void PlyReader::refuse(const std::string& what) const {
  throw InputError(path_, 0, fmt::format("{} in row {} of {} of element '{}'", what, row_ + 1, now_->count, now_->name),
                   "copy or write the file again");
}

double PlyReader::read_word() {
  const std::size_t start = rest_.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos) refuse("is cut off");
  line_ += static_cast<int>(std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(start), '\n'));
  rest_.remove_prefix(start);
  const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
  rest_.remove_prefix(word.size());
  return parse_number(path_, line_ + 1, word);
}

double PlyReader::read_value(PlyType type) {
  if (ascii_) return read_word();
  if (rest_.size() < size_of(type)) refuse("is cut off");
  return take(rest_, type);
}

PlyRow PlyReader::read_row(const PlyElement& element) {
  if (now_ != &element) row_ = 0;
  now_ = &element;
  PlyRow row;
  for (const PlyProperty& property : element.properties) {
    const double count = property.is_list ? read_value(property.count_type) : 1.0;
    if (count < 0) refuse("has a list of negative length");
    if (count > static_cast<double>(rest_.size())) refuse("is cut off");
    std::vector<double>& values = row.emplace_back();
    for (double i = 0; i < count; ++i) values.push_back(read_value(property.type));
  }
  ++row_;
  return row;
}

}  // namespace alidade
