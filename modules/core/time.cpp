// SPDX-License-Identifier: Apache-2.0
#include "core/time.h"

#include <charconv>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace alidade {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

std::optional<std::int64_t> parse_integer(std::string_view digits) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

std::optional<Timestamp> parse_floating(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(value) || std::abs(value) > 9e9) return std::nullopt;
  return Timestamp(from_seconds(value));
}

}  // namespace

double to_seconds(RecordingClock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

RecordingClock::duration from_seconds(double seconds) {
  return RecordingClock::duration(std::llround(seconds * static_cast<double>(kNanosecondsPerSecond)));
}

std::optional<Timestamp> parse_seconds(std::string_view text) {
  if (text.find_first_of("eE") != std::string_view::npos) return parse_floating(text);
  const bool negative = text.starts_with('-');
  const std::string_view magnitude = negative ? text.substr(1) : text;
  const std::size_t point = magnitude.find('.');
  const auto whole = parse_integer(magnitude.substr(0, point));
  if (!whole || *whole < 0 || *whole > 9'000'000'000) return std::nullopt;
  std::int64_t fraction = 0;
  if (point != std::string_view::npos) {
    std::string digits(magnitude.substr(point + 1));
    if (digits.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
    digits.resize(9, '0');
    fraction = parse_integer(digits).value_or(0);
  }
  const std::int64_t nanoseconds = *whole * kNanosecondsPerSecond + fraction;
  return Timestamp(std::chrono::nanoseconds(negative ? -nanoseconds : nanoseconds));
}

std::string format_seconds(Timestamp time) {
  const std::int64_t count = time.time_since_epoch().count();
  const std::uint64_t magnitude = count < 0 ? 0 - static_cast<std::uint64_t>(count) : static_cast<std::uint64_t>(count);
  return fmt::format("{}{}.{:09}", count < 0 ? "-" : "", magnitude / kNanosecondsPerSecond,
                     magnitude % kNanosecondsPerSecond);
}

}  // namespace alidade
