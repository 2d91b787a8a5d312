// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_options.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(PaperOptions, AreRefusedByName) {
  EXPECT_NO_THROW(validate(PaperOptions{}));
  PaperOptions options;
  options.periods = 0;
  try {
    validate(options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "periods must be >= 1, got 0");
  }
  for (double PaperOptions::*field : {&PaperOptions::period_s, &PaperOptions::pair_threshold_m,
                                      &PaperOptions::alternative_group_m, &PaperOptions::proposed_group_m}) {
    options = {};
    options.*field = std::nan("");
    EXPECT_THROW(validate(options), std::invalid_argument);
  }
  options = {};
  options.motion = PaperMotion::Still;
  EXPECT_THROW(validate(options), std::invalid_argument);
}

TEST(PaperOptions, TheGroupThresholdIsTheMethods) {
  PaperOptions options;
  EXPECT_EQ(group_threshold_m(options), 10.0);
  options.method = PaperMethod::Alternative;
  EXPECT_EQ(group_threshold_m(options), 3.0);
}

}  // namespace
}  // namespace alidade
