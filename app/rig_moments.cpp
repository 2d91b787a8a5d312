// SPDX-License-Identifier: Apache-2.0
#include "app/rig_moments.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace alidade {
namespace {

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::optional<long long> last_number(const std::string& name) {
  std::size_t end = name.size();
  while (end > 0 && !is_digit(name[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && is_digit(name[begin - 1])) --begin;
  if (begin == end || end - begin > 15) return std::nullopt;
  return std::stoll(name.substr(begin, end - begin));
}

// The number of every view's image; empty where one has none or two have the same.
std::optional<std::vector<long long>> numbers_of(const BoardImages& camera) {
  std::vector<long long> numbers;
  for (const BoardView& view : camera.views) {
    const auto number = last_number(view.name);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  if (std::set(numbers.begin(), numbers.end()).size() != numbers.size()) return std::nullopt;
  return numbers;
}

Moments moments_by_key(const std::vector<std::vector<long long>>& keys, MomentsBy by) {
  std::map<long long, int> moment_of;
  for (const auto& of_camera : keys) {
    for (const long long key : of_camera) moment_of.emplace(key, 0);
  }
  Moments moments;
  moments.by = by;
  for (auto& [key, moment] : moment_of) moment = moments.count++;
  for (const auto& of_camera : keys) {
    auto& of_view = moments.of_view.emplace_back();
    for (const long long key : of_camera) of_view.push_back(moment_of[key]);
  }
  return moments;
}

double shortest_interval_s(std::span<const BoardImages> cameras) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const BoardImages& camera : cameras) {
    for (std::size_t i = 1; i < camera.views.size(); ++i) {
      const double interval = camera.views[i].time_s - camera.views[i - 1].time_s;
      const int frames = std::max(1, camera.views[i].frame - camera.views[i - 1].frame);
      if (interval > 0) shortest = std::min(shortest, interval / frames);
    }
  }
  return shortest;
}

// Times in order; one that follows within `tolerance_s` of the first of its moment belongs to it.
Moments moments_by_time(std::span<const BoardImages> cameras, double tolerance_s) {
  std::vector<double> times;
  for (const BoardImages& camera : cameras) {
    for (const BoardView& view : camera.views) times.push_back(view.time_s);
  }
  std::sort(times.begin(), times.end());
  std::vector<double> starts;
  for (const double time : times) {
    if (starts.empty() || time - starts.back() > tolerance_s) starts.push_back(time);
  }
  Moments moments;
  moments.by = MomentsBy::Time;
  moments.count = static_cast<int>(starts.size());
  for (const BoardImages& camera : cameras) {
    auto& of_view = moments.of_view.emplace_back();
    for (const BoardView& view : camera.views) {
      const auto after = std::upper_bound(starts.begin(), starts.end(), view.time_s);
      of_view.push_back(static_cast<int>(after - starts.begin()) - 1);
    }
  }
  return moments;
}

}  // namespace

Moments match_moments(std::span<const BoardImages> cameras) {
  if (std::all_of(cameras.begin(), cameras.end(), [](const BoardImages& c) { return c.has_times; })) {
    return moments_by_time(cameras, 0.5 * shortest_interval_s(cameras));
  }
  std::vector<std::vector<long long>> keys;
  for (const BoardImages& camera : cameras) {
    if (auto numbers = numbers_of(camera)) keys.push_back(std::move(*numbers));
  }
  if (keys.size() == cameras.size()) return moments_by_key(keys, MomentsBy::Number);
  keys.clear();
  for (const BoardImages& camera : cameras) {
    auto& frames = keys.emplace_back();
    for (const BoardView& view : camera.views) frames.push_back(view.frame);
  }
  return moments_by_key(keys, MomentsBy::Order);
}

std::string camera_name(const std::string& source, int index) {
  const std::filesystem::path path(source);
  std::string name = path.filename().string();
  if (name.empty()) name = path.parent_path().filename().string();
  name = name.substr(0, name.find_first_of("*?[."));
  while (!name.empty() && (is_digit(name.back()) || name.back() == '_' || name.back() == '-')) name.pop_back();
  return name.empty() ? fmt::format("camera{}", index) : name;
}

}  // namespace alidade
