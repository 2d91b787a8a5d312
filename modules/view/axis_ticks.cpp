// SPDX-License-Identifier: Apache-2.0
#include "view/axis_ticks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

double round_step(double rough) {
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double mantissa = rough / power;
  return power * (mantissa < 1.5 ? 1.0 : mantissa < 3.5 ? 2.0 : mantissa < 7.5 ? 5.0 : 10.0);
}

std::string print(double value, double step, double largest) {
  if (largest >= 1e7 || largest < 1e-4) {  // so many zeros that an exponent reads better
    const int digits = std::max(0, static_cast<int>(std::floor(std::log10(largest)) - std::floor(std::log10(step))));
    return fmt::format("{:.{}e}", value, digits);
  }
  return fmt::format("{:.{}f}", value, std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9))));
}

}  // namespace

std::vector<Tick> linear_ticks(double low, double high, int wanted) {
  if (!(low < high) || !std::isfinite(low) || !std::isfinite(high)) {
    throw std::invalid_argument(fmt::format("linear_ticks: low < high needed, got {} and {}", low, high));
  }
  const double step = round_step((high - low) / std::max(1, wanted));
  const double largest = std::max(std::abs(low), std::abs(high));
  std::vector<Tick> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && ticks.size() < 100; ++k) {
    const double value = k == 0 ? 0.0 : k * step;
    ticks.push_back({value, value == 0 ? "0" : print(value, step, largest)});
  }
  return ticks;
}

std::vector<Tick> logarithmic_ticks(double low, double high, int most) {
  if (!(low > 0) || !(low < high) || !std::isfinite(high)) {
    throw std::invalid_argument(fmt::format("logarithmic_ticks: 0 < low < high needed, got {} and {}", low, high));
  }
  const int first = static_cast<int>(std::ceil(std::log10(low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(high) + 1e-9));
  const int stride = std::max(1, (last - first) / std::max(1, most) + 1);
  std::vector<Tick> ticks;
  for (int power = first - 1; power <= last; ++power) {
    for (double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10.0, power);
      const bool shown = factor == 1.0 ? (power - first) % stride == 0 : last - first < 1;
      if (shown && value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) {
        ticks.push_back({value, fmt::format("{:.4g}", value)});
      }
    }
  }
  return ticks.size() < 2 ? linear_ticks(low, high, most) : ticks;
}

}  // namespace alidade
