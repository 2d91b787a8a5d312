// SPDX-License-Identifier: Apache-2.0
#include "io/line_images.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "io/image_files.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

LineImageSet example() {
  LineImageSet set;
  set.rate_hz = 249.5;
  set.first_time = *parse_seconds("1305031229.528748001");
  set.spot_sigma_px = 1.25;
  set.read_noise = 7.5;
  set.counts_per_electron = 0.625;
  set.saturation = 250;
  set.signs = {{1, "1101", 3, std::nullopt}, {7, "1", std::nullopt, std::array{0.25, 0.5, 1.0}}};
  return set;
}

TEST(LineImageSet, IsReadAsItWasWritten) {
  const test::TemporaryDirectory folder;
  write_line_image_set(folder.path(), example());
  folder.write("detector_10.png", "");
  folder.write("detector_2_1.png", "");
  folder.write("detector_2_0.png", "");
  const LineImageSet set = read_line_image_set(folder.path());
  EXPECT_EQ(set.rate_hz, 249.5);
  EXPECT_EQ(set.first_time, example().first_time);
  EXPECT_EQ(set.spot_sigma_px, 1.25);
  EXPECT_EQ(set.read_noise, 7.5);
  EXPECT_EQ(set.counts_per_electron, 0.625);
  EXPECT_EQ(set.saturation, 250);
  ASSERT_EQ(set.signs.size(), 2u);
  EXPECT_EQ(set.signs[0].code, "1101");
  EXPECT_EQ(set.signs[0].phase, 3);
  EXPECT_EQ(set.signs[1].id, 7);
  EXPECT_EQ(set.signs[1].colour, (std::array{0.25, 0.5, 1.0}));
  ASSERT_EQ(set.detectors.size(), 2u);
  EXPECT_EQ(set.detectors[0].detector, 2);
  ASSERT_EQ(set.detectors[0].parts.size(), 2u);
  EXPECT_EQ(set.detectors[0].parts[1].filename(), "detector_2_1.png");
  EXPECT_EQ(set.detectors[1].parts[0].filename(), "detector_10.png");
}

TEST(LineImageSet, NamesTheLineThatIsWrong) {
  const test::TemporaryDirectory folder;
  folder.write("detector_0.png", "");
  const auto message = [&](const char* yaml) {
    folder.write("lines.yaml", yaml);
    return test::message_of(folder.path(), [&] { read_line_image_set(folder.path()); });
  };
  EXPECT_EQ(message("rate_hz: 0\n"), "lines.yaml:1: rate_hz must be > 0, got 0");
  EXPECT_EQ(message("rate_h: 250\n"), "lines.yaml:1: unknown key 'rate_h'; did you mean 'rate_hz'?");
  EXPECT_EQ(message("rate_hz: 250\n"), "lines.yaml:1: the recording has no 'markers'");
  EXPECT_EQ(message("rate_hz: 250\nmarkers:\n  - {id: 1}\n  - {code: \"10\"}\n"),
            "lines.yaml:4: the marker has no 'id'");
  EXPECT_EQ(message("rate_hz: 250\nmarkers:\n  - {id: 1}\n  - {id: 1}\n"), "lines.yaml:4: marker 1 is listed twice");
  EXPECT_EQ(message("rate_hz: 250\nmarkers:\n  - {id: 1, code: \"12\"}\n"),
            "lines.yaml:3: the code must consist of 0 and 1 and be lit once, got '12'; a row of the recording each, "
            "e.g. \"1110110011100\"");
  EXPECT_EQ(message("rate_hz: 250\nmarkers:\n  - {id: 1, code: \"10\", phase: 2}\n"),
            "lines.yaml:3: the phase must be 0 to 1, got 2");
  EXPECT_EQ(message("rate_hz: .nan\nmarkers:\n  - {id: 1}\n"), "lines.yaml:1: '.nan' is not a number");
  EXPECT_EQ(message("rate_hz: 250\nnoise: {read: -1}\nmarkers:\n  - {id: 1}\n"),
            "lines.yaml:2: read must be >= 0, got -1");
}

TEST(LineImageSet, NamesTheImageThatIsWrong) {
  const test::TemporaryDirectory folder;
  const auto message = [&] { return test::message_of(folder.path(), [&] { read_line_image_set(folder.path()); }); };
  folder.write("lines.yaml", "rate_hz: 250\nmarkers:\n  - {id: 1}\n");
  EXPECT_NE(message().find("holds no line images; they are called detector_ID.png"), std::string::npos) << message();
  folder.write("detector_3_0.png", "");
  folder.write("detector_3_2.png", "");
  EXPECT_EQ(message(), "detector_3_2.png: part 1 before it is missing");
  std::filesystem::remove(folder / "detector_3_2.png");
  folder.write("detector_3.png", "");
  EXPECT_EQ(message(), "detector_3.png: stands beside parts of detector 3; keep the whole or the parts");
  std::filesystem::remove(folder / "detector_3.png");
  folder.write("left.png", "");
  EXPECT_EQ(message(), "left.png: is the image of no detector; name it detector_ID.png");
}

TEST(ReadLineImage, KeepsSixteenBitsAndColours) {
  const test::TemporaryDirectory folder;
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
    cv::Mat image(5, 40, type);
    cv::randu(image, 0, CV_MAT_DEPTH(type) == CV_8U ? 255 : 65535);
    write_image(folder / "detector_0.png", image);
    const cv::Mat read = read_line_image(folder / "detector_0.png");
    ASSERT_EQ(read.type(), type);
    EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0.0);
  }
}

TEST(ReadLineImage, SaysWhatIsDamaged) {
  const test::TemporaryDirectory folder;
  folder.write("detector_0.png", "no image");
  EXPECT_EQ(test::message_of(folder.path(), [&] { read_line_image(folder / "detector_0.png"); }),
            "detector_0.png: is no readable image; PNG, JPEG, BMP, PNM, TIFF or WebP is wanted");
}

}  // namespace
}  // namespace alidade
