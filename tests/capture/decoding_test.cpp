// SPDX-License-Identifier: Apache-2.0
#include "capture/decoding.h"

#include <vector>

#include <gtest/gtest.h>
#include <turbojpeg.h>

namespace alidade {
namespace {

cv::Vec3b bgr_at(const cv::Mat& image) {
  return image.at<cv::Vec3b>(image.rows / 2, image.cols / 2);
}

cv::Mat jpeg_of(const cv::Mat& image) {
  tjhandle handle = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool is_grey = image.channels() == 1;
  EXPECT_EQ(tjCompress2(handle, image.data, image.cols, static_cast<int>(image.step), image.rows,
                        is_grey ? TJPF_GRAY : TJPF_BGR, &bytes, &size, is_grey ? TJSAMP_GRAY : TJSAMP_444, 100, 0),
            0);
  cv::Mat result = cv::Mat(1, static_cast<int>(size), CV_8UC1, bytes).clone();
  tjFree(bytes);
  tjDestroy(handle);
  return result;
}

TEST(Decoding, CutsToTheUpperEightBits) {
  const cv::Mat twelve = (cv::Mat_<std::uint16_t>(1, 5) << 0, 15, 16, 31, 4095);
  const cv::Mat eight = decode(twelve, {PixelKind::Grey, 12});
  EXPECT_EQ(cv::countNonZero(eight != (cv::Mat_<std::uint8_t>(1, 5) << 0, 0, 1, 1, 255)), 0);
}

TEST(Decoding, LeavesEightBitsAsTheyAre) {
  const cv::Mat grey(3, 4, CV_8UC1, cv::Scalar(7));
  EXPECT_EQ(decode(grey, {PixelKind::Grey}).data, grey.data);
}

TEST(Decoding, FillsAMosaicInEveryPattern) {
  // A scene of one colour, blue 10, green 90, red 200, seen through each mosaic.
  const auto mosaic = [](int tl, int tr, int bl, int br) {
    cv::Mat image(8, 8, CV_8UC1);
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x)
        image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(y % 2 ? (x % 2 ? br : bl) : (x % 2 ? tr : tl));
    }
    return image;
  };
  const cv::Vec3b scene(10, 90, 200);
  EXPECT_EQ(bgr_at(decode(mosaic(200, 90, 90, 10), {PixelKind::Bayer, 8, BayerPattern::RGGB})), scene);
  EXPECT_EQ(bgr_at(decode(mosaic(90, 200, 10, 90), {PixelKind::Bayer, 8, BayerPattern::GRBG})), scene);
  EXPECT_EQ(bgr_at(decode(mosaic(90, 10, 200, 90), {PixelKind::Bayer, 8, BayerPattern::GBRG})), scene);
  EXPECT_EQ(bgr_at(decode(mosaic(10, 90, 90, 200), {PixelKind::Bayer, 8, BayerPattern::BGGR})), scene);
}

TEST(Decoding, TurnsLumaAndDifferencesIntoGrey) {
  const cv::Mat yuyv(4, 4, CV_8UC2, cv::Scalar(126, 128));
  const cv::Mat nv12(6, 4, CV_8UC1, cv::Scalar(126));
  nv12.rowRange(4, 6).setTo(128);
  const cv::Vec3b grey(128, 128, 128);  // 1.164 (126 - 16)
  EXPECT_EQ(bgr_at(decode(yuyv, {PixelKind::Yuyv})), grey);
  EXPECT_EQ(bgr_at(decode(nv12, {PixelKind::Nv12})), grey);
}

TEST(Decoding, ReadsJpegsGreyOrInColour) {
  const cv::Mat colour(16, 24, CV_8UC3, cv::Scalar(10, 90, 200));
  const cv::Mat decoded_colour = decode(jpeg_of(colour), {PixelKind::Jpeg});
  ASSERT_EQ(decoded_colour.size(), colour.size());
  EXPECT_LE(cv::norm(decoded_colour, colour, cv::NORM_INF), 2);
  const cv::Mat grey(16, 24, CV_8UC1, cv::Scalar(77));
  const cv::Mat decoded_grey = decode(jpeg_of(grey), {PixelKind::Jpeg});
  EXPECT_EQ(decoded_grey.type(), CV_8UC1);
  EXPECT_LE(cv::norm(decoded_grey, grey, cv::NORM_INF), 1);
}

TEST(Decoding, IsEmptyForAJpegThatIsCutShort) {
  cv::Mat noise(64, 64, CV_8UC3);
  cv::randu(noise, 0, 255);
  const cv::Mat jpeg = jpeg_of(noise);
  EXPECT_TRUE(decode(jpeg.colRange(0, jpeg.cols / 2).clone(), {PixelKind::Jpeg}).empty());
  EXPECT_TRUE(decode(cv::Mat(1, 10, CV_8UC1, cv::Scalar(3)), {PixelKind::Jpeg}).empty());
  EXPECT_TRUE(decode(cv::Mat(), {PixelKind::Jpeg}).empty());
}

class Frames : public FrameSource {
 public:
  explicit Frames(std::vector<Frame> frames) : frames_(std::move(frames)) {}
  std::optional<Frame> next(std::stop_token) override {
    return next_ < frames_.size() ? std::optional(frames_[next_++]) : std::nullopt;
  }
  std::optional<int> frame_count() const override { return std::nullopt; }
  bool has_times() const override { return true; }
  std::string describe() const override { return "frames"; }

 private:
  std::vector<Frame> frames_;
  std::size_t next_ = 0;
};

TEST(Decoding, LeavesDamagedFramesOutAndCountsThem) {
  std::vector<Frame> frames(4);
  for (int i = 0; i < 4; ++i) {
    frames[static_cast<std::size_t>(i)].index = i;
    frames[static_cast<std::size_t>(i)].image = cv::Mat(2, 2, CV_16UC1, cv::Scalar(256 * i));
    frames[static_cast<std::size_t>(i)].format = {PixelKind::Grey, 16};
  }
  frames[1].stamp.is_damaged = true;
  frames[1].stamp.dropped_before = 3;
  frames[2].image = cv::Mat();
  frames[3].stamp.discarded_before = 2;
  const auto source = decoded(std::make_unique<Frames>(frames));
  EXPECT_EQ(source->next()->index, 0);
  const auto frame = source->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->index, 3);
  EXPECT_EQ(frame->image.at<std::uint8_t>(0, 0), 3);
  EXPECT_EQ(frame->format, PixelFormat{});
  EXPECT_EQ(frame->stamp.dropped_before, 5u);  // 3 that never came, 2 that were left out
  EXPECT_EQ(frame->stamp.discarded_before, 2u);
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->fault(), "2 damaged frames left out");
}

}  // namespace
}  // namespace alidade
