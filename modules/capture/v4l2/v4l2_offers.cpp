// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_offers.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "capture/v4l2/v4l2_formats.h"

namespace alidade {
namespace {

// A driver that never ends its list would hang us; no real one has more entries.
constexpr std::uint32_t kMostEntries = 256;

cv::Size size_of(std::uint32_t width, std::uint32_t height) {
  return {static_cast<int>(width), static_cast<int>(height)};
}

std::vector<double> rates_of(const V4l2Device& device, std::uint32_t code, cv::Size size) {
  std::vector<double> rates;
  for (const v4l2_fract& period : v4l2_periods(device, code, size).values) rates.push_back(rate_of(period));
  std::sort(rates.rbegin(), rates.rend());
  return rates;
}

std::vector<ListedSize> sizes_of(const V4l2Device& device, std::uint32_t code) {
  std::vector<ListedSize> sizes;
  v4l2_frmsizeenum told{};
  told.pixel_format = code;
  for (; told.index < kMostEntries && device.call(VIDIOC_ENUM_FRAMESIZES, &told) == 0; ++told.index) {
    ListedSize listed;
    if (told.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      listed.size = size_of(told.discrete.width, told.discrete.height);
    } else {
      listed.size = size_of(told.stepwise.max_width, told.stepwise.max_height);
      listed.least = size_of(told.stepwise.min_width, told.stepwise.min_height);
    }
    listed.fps_hz = rates_of(device, code, listed.size);
    sizes.push_back(std::move(listed));
    if (told.type != V4L2_FRMSIZE_TYPE_DISCRETE) break;
  }
  return sizes;
}

std::string sizes_text(std::span<const ListedSize> sizes) {
  std::vector<std::string> texts;
  for (const ListedSize& listed : sizes) {
    texts.push_back(listed.least ? fmt::format("{} to {}", size_text(*listed.least), size_text(listed.size))
                                 : size_text(listed.size));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace

std::vector<ListedFormat> v4l2_offers(const V4l2Device& device) {
  std::vector<ListedFormat> formats;
  v4l2_fmtdesc told{};
  told.type = device.identity().buffer_type;
  for (; told.index < kMostEntries && device.call(VIDIOC_ENUM_FMT, &told) == 0; ++told.index) {
    ListedFormat listed;
    listed.name = v4l2_format_name(told.pixelformat);
    listed.description = reinterpret_cast<const char*>(told.description);
    listed.is_readable = find_v4l2_format(told.pixelformat) != nullptr;
    listed.sizes = sizes_of(device, told.pixelformat);
    formats.push_back(std::move(listed));
  }
  return formats;
}

V4l2Periods v4l2_periods(const V4l2Device& device, std::uint32_t code, cv::Size size) {
  V4l2Periods periods;
  v4l2_frmivalenum told{};
  told.pixel_format = code;
  told.width = static_cast<std::uint32_t>(size.width);
  told.height = static_cast<std::uint32_t>(size.height);
  for (; told.index < kMostEntries && device.call(VIDIOC_ENUM_FRAMEINTERVALS, &told) == 0; ++told.index) {
    if (told.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      periods.values.push_back(told.discrete);
    } else {
      return {{told.stepwise.min, told.stepwise.max}, true};
    }
  }
  return periods;
}

double rate_of(const v4l2_fract& period) {
  return period.numerator > 0 ? static_cast<double>(period.denominator) / period.numerator : 0.0;
}

std::string describe_offers(std::span<const ListedFormat> formats) {
  std::vector<std::pair<std::string, std::string>> groups;  // sizes, names of formats
  for (const ListedFormat& format : formats) {
    if (!format.is_readable) continue;
    const std::string sizes = sizes_text(format.sizes);
    const auto known = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == sizes; });
    if (known == groups.end()) {
      groups.emplace_back(sizes, format.name);
    } else {
      known->second += ", " + format.name;
    }
  }
  std::vector<std::string> texts;
  for (const auto& [sizes, names] : groups) texts.push_back(sizes.empty() ? names : names + " at " + sizes);
  return fmt::format("{}", fmt::join(texts, "; "));
}

std::string size_text(cv::Size size) {
  return fmt::format("{}x{}", size.width, size.height);
}

}  // namespace alidade
