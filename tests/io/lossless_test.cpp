// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "io/lossless_decoder.h"
#include "io/lossless_encoder.h"

namespace alidade {
namespace {

constexpr std::array kCodecs{LosslessCodec::Raw, LosslessCodec::FfvHuff, LosslessCodec::Ffv1};
constexpr std::array kLayouts{PixelLayout::Grey8, PixelLayout::Grey16, PixelLayout::Bgr24, PixelLayout::Yuyv,
                              PixelLayout::Nv12};
const cv::Size kSize{66, 38};

// Noise, every value of which counts.
cv::Mat noise(PixelLayout layout, cv::Size size, std::uint64_t seed) {
  cv::Mat image(mat_size(layout, size), mat_type(layout));
  cv::RNG(seed).fill(image, cv::RNG::UNIFORM, 0, layout == PixelLayout::Grey16 ? 65536 : 256);
  return image;
}

bool are_equal(const cv::Mat& a, const cv::Mat& b) {
  return a.type() == b.type() && a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

std::string title(PixelLayout layout, LosslessCodec codec) {
  return fmt::format("layout {}, {}", static_cast<int>(layout), name_of(codec));
}

TEST(LosslessFrame, OfEveryLayoutComesBackBitByBitFromEveryCodec) {
  for (const PixelLayout layout : kLayouts) {
    for (const LosslessCodec codec : kCodecs) {
      const LosslessFormat format{layout, kSize, codec};
      LosslessEncoder encoder(format);
      LosslessDecoder decoder(format, encoder.track({}).codec_private);
      for (std::uint64_t seed = 1; seed < 4; ++seed) {
        const cv::Mat image = noise(layout, kSize, seed);
        const auto back = decoder.decode(encoder.encode(image));
        ASSERT_TRUE(back) << title(layout, codec);
        EXPECT_TRUE(are_equal(*back, image)) << title(layout, codec);
      }
    }
  }
}

TEST(LosslessFrame, MayBeAPartOfALargerImage) {
  for (const PixelLayout layout : kLayouts) {
    for (const LosslessCodec codec : kCodecs) {
      const LosslessFormat format{layout, kSize, codec};
      const cv::Mat whole = noise(layout, {kSize.width + 30, kSize.height + 20}, 5);
      const cv::Mat image = whole(cv::Rect({10, 8}, mat_size(layout, kSize)));
      LosslessEncoder encoder(format);
      LosslessDecoder decoder(format, encoder.track({}).codec_private);
      const auto back = decoder.decode(encoder.encode(image));
      ASSERT_TRUE(back) << title(layout, codec);
      EXPECT_TRUE(are_equal(*back, image)) << title(layout, codec);
    }
  }
}

TEST(LosslessFrame, MayBeOfOddSizeWhereNothingIsHalved) {
  for (const PixelLayout layout : {PixelLayout::Grey8, PixelLayout::Grey16, PixelLayout::Bgr24}) {
    for (const LosslessCodec codec : kCodecs) {
      const LosslessFormat format{layout, {61, 37}, codec};
      const cv::Mat image = noise(layout, format.size, 5);
      LosslessEncoder encoder(format);
      LosslessDecoder decoder(format, encoder.track({}).codec_private);
      const auto back = decoder.decode(encoder.encode(image));
      ASSERT_TRUE(back) << title(layout, codec);
      EXPECT_TRUE(are_equal(*back, image)) << title(layout, codec);
    }
  }
  EXPECT_THROW(LosslessEncoder({PixelLayout::Yuyv, {61, 38}, LosslessCodec::Raw}), std::invalid_argument);
  EXPECT_THROW(LosslessEncoder({PixelLayout::Nv12, {62, 37}, LosslessCodec::Raw}), std::invalid_argument);
}

TEST(LosslessFrame, OfAJpegIsItsBytes) {
  const LosslessFormat format{PixelLayout::Jpeg, kSize, LosslessCodec::Raw};
  LosslessEncoder encoder(format);
  LosslessDecoder decoder(format, "");
  for (const int length : {900, 1}) {
    cv::Mat image(1, length, CV_8UC1);
    cv::RNG(3).fill(image, cv::RNG::UNIFORM, 0, 256);
    const auto back = decoder.decode(encoder.encode(image));
    ASSERT_TRUE(back);
    EXPECT_TRUE(are_equal(*back, image));
  }
  EXPECT_THROW(LosslessEncoder({PixelLayout::Jpeg, kSize, LosslessCodec::Ffv1}), std::invalid_argument);
}

TEST(LosslessFrame, OfAnotherSizeOrTypeIsRefused) {
  LosslessEncoder encoder({PixelLayout::Grey8, kSize, LosslessCodec::Ffv1});
  EXPECT_THROW(encoder.encode(cv::Mat(38, 64, CV_8UC1)), std::invalid_argument);
  EXPECT_THROW(encoder.encode(cv::Mat(kSize, CV_16UC1)), std::invalid_argument);
}

TEST(LosslessFrame, ThatIsCutShortIsEmptyOrOfItsSize) {
  for (const LosslessCodec codec : kCodecs) {
    const LosslessFormat format{PixelLayout::Bgr24, kSize, codec};
    LosslessEncoder encoder(format);
    LosslessDecoder decoder(format, encoder.track({}).codec_private);
    const std::string packet(encoder.encode(noise(PixelLayout::Bgr24, kSize, 1)));
    for (const std::size_t length : {std::size_t{0}, std::size_t{1}, packet.size() / 2, packet.size() - 1}) {
      const auto back = decoder.decode(std::string_view(packet).substr(0, length));
      EXPECT_TRUE(!back || back->size() == kSize) << name_of(codec);
      EXPECT_FALSE(back && codec == LosslessCodec::Raw);
    }
    const auto next = decoder.decode(packet);
    ASSERT_TRUE(next) << name_of(codec) << ": a damaged packet spoils the next";
    EXPECT_TRUE(are_equal(*next, noise(PixelLayout::Bgr24, kSize, 1)));
  }
}

TEST(LosslessCodec, HasANameThatIsReadBack) {
  for (const LosslessCodec codec : kCodecs) EXPECT_EQ(parse_lossless_codec(name_of(codec)), codec);
  EXPECT_FALSE(parse_lossless_codec("h264"));
}

}  // namespace
}  // namespace alidade
