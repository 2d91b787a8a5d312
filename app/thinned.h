// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace alidade {

/// Values of a stream, evenly thinned so that never more than `most` are kept: every one at first, then every second,
/// every fourth.
template <class T>
class Thinned {
 public:
  /// Throws std::invalid_argument for fewer than 2.
  explicit Thinned(std::size_t most) : most_(most) {
    if (most < 2) throw std::invalid_argument("Thinned: most must be >= 2");
  }

  void add(T value) {
    if (count_++ % stride_ != 0) return;
    if (values_.size() == most_) {
      halve();
      if ((count_ - 1) % stride_ != 0) return;
    }
    values_.push_back(std::move(value));
  }

  const std::vector<T>& values() const { return values_; }

  /// How many there were for each that is kept.
  std::int64_t stride() const { return stride_; }

 private:
  void halve() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values_.size(); i += 2, ++kept) {
      if (i != kept) values_[kept] = std::move(values_[i]);
    }
    values_.resize(kept);
    stride_ *= 2;
  }

  std::size_t most_;
  std::int64_t count_ = 0, stride_ = 1;
  std::vector<T> values_;
};

}  // namespace alidade
