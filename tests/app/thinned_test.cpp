// SPDX-License-Identifier: Apache-2.0
#include "app/thinned.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(Thinned, KeepsAllOfFewValues) {
  Thinned<int> thinned(4);
  for (int i = 0; i < 4; ++i) thinned.add(i);
  EXPECT_EQ(thinned.values(), (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(thinned.stride(), 1);
}

TEST(Thinned, KeepsEveryStrideThOfManyFromTheFirstOn) {
  for (const int count : {5, 8, 9, 100, 9'000, 100'000}) {
    Thinned<int> thinned(64);
    for (int i = 0; i < count; ++i) thinned.add(i);
    const auto stride = static_cast<int>(thinned.stride());
    const auto& values = thinned.values();
    ASSERT_LE(values.size(), 64u);
    ASSERT_EQ(values.size(), static_cast<std::size_t>((count + stride - 1) / stride)) << count;
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], stride * static_cast<int>(i));
    EXPECT_GE(values.size(), static_cast<std::size_t>(std::min(count, 32)));
  }
}

TEST(Thinned, NeedsRoomForTwo) {
  EXPECT_THROW(Thinned<int>(1), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
