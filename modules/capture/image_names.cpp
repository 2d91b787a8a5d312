// SPDX-License-Identifier: Apache-2.0
#include "capture/image_names.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "core/errors.h"
#include "io/image_files.h"
#include "io/natural_order.h"

namespace alidade {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::optional<Timestamp> time_in_name(const std::filesystem::path& image) {
  const std::string stem = image.stem();
  const bool digits = std::all_of(stem.begin(), stem.end(), is_digit);
  if (digits && stem.size() >= 16 && stem.size() <= 19) {
    return Timestamp(std::chrono::nanoseconds(std::stoll(stem)));
  }
  const std::size_t point = stem.find('.');
  if (point == std::string::npos || point == 0 || stem.size() - point < 4) return std::nullopt;
  const bool decimal = std::all_of(stem.begin(), stem.end(), [](char c) { return is_digit(c) || c == '.'; });
  return decimal ? parse_seconds(stem) : std::nullopt;
}

}  // namespace

std::vector<std::filesystem::path> list_images(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> images;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file() && has_image_extension(entry.path())) images.push_back(entry.path());
  }
  if (error) throw InputError(folder, 0, "cannot be opened: " + error.message(), "check the name");
  if (images.empty()) throw InputError(folder, 0, "holds no images", "name a folder with .jpg or .png files");
  std::sort(images.begin(), images.end(),
            [](const auto& a, const auto& b) { return natural_less(a.filename().native(), b.filename().native()); });
  return images;
}

std::optional<std::vector<Timestamp>> times_in_names(std::span<const std::filesystem::path> images) {
  std::vector<Timestamp> times;
  for (const auto& image : images) {
    const auto time = time_in_name(image);
    if (!time || (!times.empty() && *time <= times.back())) return std::nullopt;
    times.push_back(*time);
  }
  if (times.empty()) return std::nullopt;
  return times;
}

}  // namespace alidade
