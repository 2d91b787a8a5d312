// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace alidade {

/// The middle one of `values` by size; of an even number the upper of the two in the middle. Throws
/// std::invalid_argument where there is none.
template <class T>
T median(std::vector<T> values) {
  if (values.empty()) throw std::invalid_argument("median: of no value");
  const auto middle = values.begin() + static_cast<typename std::vector<T>::difference_type>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace alidade
