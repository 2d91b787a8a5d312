// SPDX-License-Identifier: Apache-2.0
#include "core/find_by_id.h"

#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

struct Named {
  int id;
};

TEST(FindById, FindsAtItsPlaceAndElsewhere) {
  const std::vector<Named> items{{0}, {1}, {7}, {-4}, {2}};
  for (const std::size_t i : {0u, 1u, 2u, 3u, 4u}) EXPECT_EQ(find_by_id<Named>(items, items[i].id), &items[i]);
}

TEST(FindById, IsNullForAnIdThatIsNotThere) {
  const std::vector<Named> items{{5}, {6}};
  EXPECT_EQ(find_by_id<Named>(items, 0), nullptr);
  EXPECT_EQ(find_by_id<Named>(items, -1), nullptr);
  EXPECT_EQ(find_by_id<Named>({}, 0), nullptr);
}

}  // namespace
}  // namespace alidade
