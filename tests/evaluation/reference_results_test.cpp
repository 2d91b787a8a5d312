// SPDX-License-Identifier: Apache-2.0
#include "tests/evaluation/reference_results.h"

#include <gtest/gtest.h>

#include "tests/support/data_directory.h"

namespace alidade {
namespace {

TEST(ReferenceResults, AgreeWithEvoToThePrintedDigits) {
  const auto folder = test::data_directory("trajectories");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const std::vector<ReferenceCase> cases = read_reference_cases(folder);
  ASSERT_EQ(cases.size(), 20u);
  for (const ReferenceCase& reference : cases) {
    for (const ReferenceValue& value : compare(reference)) {
      EXPECT_EQ(value.ours, value.evo) << value.statistic << " of " << reference.command;
    }
  }
}

}  // namespace
}  // namespace alidade
