// SPDX-License-Identifier: Apache-2.0
#include "io/nearest_name.h"

#include <array>

#include <gtest/gtest.h>

namespace alidade {
namespace {

constexpr std::array<std::string_view, 3> kKnown{"resolution_px", "intrinsics_px", "model"};

TEST(NearestName, FindsTheOneThatWasMeant) {
  EXPECT_EQ(nearest_name("resolution", kKnown), "resolution_px");
  EXPECT_EQ(nearest_name("modle", kKnown), "model");
  EXPECT_EQ(nearest_name("model", kKnown), "model");
}

TEST(NearestName, IsEmptyWhereNoneIsNear) {
  EXPECT_EQ(nearest_name("zzzzz", kKnown), "");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(SuggestName, ListsAllWhereNoneIsNear) {
  EXPECT_EQ(suggest_name("modell", kKnown), "did you mean 'model'?");
  EXPECT_EQ(suggest_name("zzzzz", kKnown), "known are: resolution_px, intrinsics_px, model");
}

}  // namespace
}  // namespace alidade
