// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/block_ids.h"

#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

std::vector<std::uint64_t> unwrapped(const std::vector<std::uint64_t>& ids) {
  BlockIds block_ids;
  std::vector<std::uint64_t> result;
  for (const std::uint64_t id : ids) result.push_back(block_ids.unwrapped(id));
  return result;
}

using Ids = std::vector<std::uint64_t>;

TEST(BlockIds, PassAsTheyAreBeforeTheWrap) {
  EXPECT_EQ(unwrapped({1, 2, 3, 5, 65534}), (Ids{1, 2, 3, 5, 65534}));
}

TEST(BlockIds, GoOnAfterTheWrapWhichLeavesOutZero) {
  EXPECT_EQ(unwrapped({65534, 65535, 1, 2}), (Ids{65534, 65535, 65536, 65537}));
}

TEST(BlockIds, CountWhatIsLostAcrossTheWrap) {
  EXPECT_EQ(unwrapped({65533, 3}), (Ids{65533, 65538}));
}

TEST(BlockIds, WrapManyTimes) {
  BlockIds ids;
  std::uint64_t expected = 0;
  for (int i = 0; i < 200000; ++i) ASSERT_EQ(ids.unwrapped(static_cast<std::uint64_t>(i) % 65535 + 1), ++expected);
}

TEST(BlockIds, StartAnewWhenTheCameraDoes) {
  EXPECT_EQ(unwrapped({1000, 1001, 1, 2}), (Ids{1000, 1001, 1, 2}));
}

TEST(BlockIds, PassAsTheyAreWhereTheyAreExtended) {
  EXPECT_EQ(unwrapped({65535, 65536, 131070, 1, 2}), (Ids{65535, 65536, 131070, 1, 2}));
}

}  // namespace
}  // namespace alidade
