// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_choice.h"

#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

V4l2Candidate candidate(std::uint32_t code, std::vector<v4l2_fract> periods) {
  return {find_v4l2_format(code), {std::move(periods), false}};
}

const v4l2_fract kTenth{1, 10}, kThirtieth{1, 30}, kSixtieth{1, 60}, kNtsc{1001, 30000};

TEST(V4l2Choice, TakesGreyBeforeColourBeforeJpeg) {
  const std::vector all{candidate(V4L2_PIX_FMT_MJPEG, {kThirtieth}), candidate(V4L2_PIX_FMT_YUYV, {kThirtieth}),
                        candidate(V4L2_PIX_FMT_GREY, {kThirtieth})};
  EXPECT_EQ(preferred(all, 30)->format->code, V4L2_PIX_FMT_GREY);
  EXPECT_EQ(preferred(std::span(all).first(2), 30)->format->code, V4L2_PIX_FMT_YUYV);
  EXPECT_EQ(preferred(std::span(all).first(1), 30)->format->code, V4L2_PIX_FMT_MJPEG);
  EXPECT_EQ(preferred({}, 30), nullptr);
}

TEST(V4l2Choice, TakesJpegWhereOnlyItIsFastEnough) {
  const std::vector webcam{candidate(V4L2_PIX_FMT_YUYV, {kTenth}),
                           candidate(V4L2_PIX_FMT_MJPEG, {kTenth, kThirtieth, kSixtieth})};
  EXPECT_EQ(preferred(webcam, 10)->format->code, V4L2_PIX_FMT_YUYV);
  EXPECT_EQ(preferred(webcam, 30)->format->code, V4L2_PIX_FMT_MJPEG);
  EXPECT_EQ(preferred(webcam, 500)->format->code, V4L2_PIX_FMT_MJPEG);  // the nearest that there is
}

TEST(V4l2Choice, AimsAtThirtyWhereNoRateIsAsked) {
  const std::vector slow{candidate(V4L2_PIX_FMT_YUYV, {kTenth}), candidate(V4L2_PIX_FMT_MJPEG, {kSixtieth})};
  EXPECT_EQ(preferred(slow, {})->format->code, V4L2_PIX_FMT_MJPEG);
  const std::vector usual{candidate(V4L2_PIX_FMT_YUYV, {kThirtieth}), candidate(V4L2_PIX_FMT_MJPEG, {kSixtieth})};
  EXPECT_EQ(preferred(usual, {})->format->code, V4L2_PIX_FMT_YUYV);
  const std::vector all_slow{candidate(V4L2_PIX_FMT_YUYV, {kTenth}), candidate(V4L2_PIX_FMT_MJPEG, {kTenth})};
  EXPECT_EQ(preferred(all_slow, {})->format->code, V4L2_PIX_FMT_YUYV);
}

TEST(V4l2Choice, TakesNtscForThirtyAndBelievesDriversThatTellNothing) {
  const std::vector ntsc{candidate(V4L2_PIX_FMT_YUYV, {kNtsc}), candidate(V4L2_PIX_FMT_MJPEG, {kThirtieth})};
  EXPECT_EQ(preferred(ntsc, 30)->format->code, V4L2_PIX_FMT_YUYV);
  const std::vector silent{candidate(V4L2_PIX_FMT_YUYV, {}), candidate(V4L2_PIX_FMT_MJPEG, {kThirtieth})};
  EXPECT_EQ(preferred(silent, 30)->format->code, V4L2_PIX_FMT_YUYV);
}

TEST(V4l2Choice, TakesTheNearestPeriod) {
  const V4l2Periods offered{{kTenth, kThirtieth, kSixtieth}, false};
  EXPECT_EQ(nearest_period(offered, 29).denominator, 30U);
  EXPECT_EQ(nearest_period(offered, 1).denominator, 10U);
  const V4l2Periods range{{kSixtieth, kTenth}, true};
  EXPECT_DOUBLE_EQ(rate_of(nearest_period(range, 25)), 25);
  EXPECT_DOUBLE_EQ(rate_of(nearest_period({}, 12.5)), 12.5);
}

}  // namespace
}  // namespace alidade
