// SPDX-License-Identifier: Apache-2.0
#include "core/nearest_name.h"

#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

const std::vector<std::string_view> kVerbs = {"track", "map", "evaluate"};

TEST(EditDistance, CountsInsertionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("gate", "gate"), 0);
  EXPECT_EQ(edit_distance("gate", "gates"), 1);
  EXPECT_EQ(edit_distance("gate", "gite"), 1);
  EXPECT_EQ(edit_distance("gate", "gaet"), 1);  // two neighbours swapped
  EXPECT_EQ(edit_distance("", "gate"), 4);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(NearestName, IsTheNameWithTheFewestEdits) {
  EXPECT_EQ(nearest_name("trak", kVerbs), "track");
  EXPECT_EQ(nearest_name("evalute", kVerbs), "evaluate");
}

TEST(NearestName, IsEmptyWhereNothingIsNear) {
  EXPECT_FALSE(nearest_name("calibrate", kVerbs));
  EXPECT_FALSE(nearest_name("xy", kVerbs));
  EXPECT_FALSE(nearest_name("track", {}));
}

TEST(SuggestName, ListsTheKnownNamesWhereNoneIsNear) {
  EXPECT_EQ(suggest_name("mapp", kVerbs), "did you mean 'map'?");
  EXPECT_EQ(suggest_name("calibrate", kVerbs), "known are: track, map, evaluate");
  EXPECT_EQ(suggest_name("anything", {}), "");
}

}  // namespace
}  // namespace alidade
