// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/genicam/figure.h"

#include <gtest/gtest.h>

namespace alidade::test {
namespace {

bool is_met(double value, std::optional<double> at_least, std::optional<double> at_most) {
  return Figure{"", "", value, "", at_least, at_most}.is_met();
}

TEST(Figure, IsMetWithinItsBounds) {
  EXPECT_TRUE(is_met(5, {}, {}));
  EXPECT_TRUE(is_met(5, 5, 5));
  EXPECT_FALSE(is_met(5.1, {}, 5));
  EXPECT_FALSE(is_met(4.9, 5, {}));
}

TEST(Figure, IsOneLineOfJson) {
  const Figure figure{.section = "kill", .name = "event", .value = 133.5, .unit = "ms", .at_most = 266};
  EXPECT_EQ(to_json(figure),
            R"({"section":"kill","name":"event","value":133.5,"unit":"ms","at_most":266.0,"is_met":true})");
}

TEST(Quantile, IsTheLargestAtOneAndTheMiddleAtAHalf) {
  EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile({3, 1, 2}, 1), 3);
  EXPECT_EQ(quantile({}, 0.5), 0);
}

}  // namespace
}  // namespace alidade::test
