// SPDX-License-Identifier: Apache-2.0
#include "capture/capture_event.h"

#include <set>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(CaptureEvent, HasANameOfItsOwnForEveryKindAndComesBackFromIt) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(CaptureEventKind::Closed); ++i) {
    const auto kind = static_cast<CaptureEventKind>(i);
    EXPECT_FALSE(name_of(kind).empty()) << i;
    EXPECT_TRUE(names.insert(name_of(kind)).second) << i;
    EXPECT_EQ(parse_capture_event_kind(name_of(kind)), kind);
  }
  EXPECT_FALSE(parse_capture_event_kind("gone fishing"));
}

}  // namespace
}  // namespace alidade
