// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_offers.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

ListedFormat format(const char* name, std::vector<ListedSize> sizes, bool is_readable = true) {
  return {name, "", is_readable, std::move(sizes)};
}

TEST(V4l2Offers, AreTogetherWhereTheirSizesAreEqual) {
  const std::vector<ListedSize> sizes{{{640, 480}, {}, {}}, {{320, 240}, {}, {}}};
  const std::vector formats{format("YUYV", sizes), format("H264", sizes, false), format("GREY", sizes),
                            format("MJPG", {{{1920, 1080}, cv::Size(16, 16), {}}})};
  EXPECT_EQ(describe_offers(formats), "YUYV, GREY at 640x480, 320x240; MJPG at 16x16 to 1920x1080");
  EXPECT_EQ(describe_offers({}), "");
}

TEST(V4l2Offers, NeedNoSizes) {
  const std::vector formats{format("YUYV", {})};
  EXPECT_EQ(describe_offers(formats), "YUYV");
}

TEST(V4l2Offers, HaveNoRateWithoutAPeriod) {
  EXPECT_DOUBLE_EQ(rate_of({1001, 30000}), 30000.0 / 1001);
  EXPECT_EQ(rate_of({0, 30}), 0);
}

}  // namespace
}  // namespace alidade
