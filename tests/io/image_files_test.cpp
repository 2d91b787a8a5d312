// SPDX-License-Identifier: Apache-2.0
#include "io/image_files.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "io/image_integrity.h"
#include "io/text_lines.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

class ImageFiles : public testing::Test {
 protected:
  static cv::Mat noise(int type) {
    cv::Mat image(48, 64, type);
    cv::RNG rng(7);
    rng.fill(image, cv::RNG::UNIFORM, 0, image.depth() == CV_8U ? 256 : 65536);
    return image;
  }
  std::string message(const std::string& name) {
    return test::message_of(folder_.path(), [&] { read_image(folder_ / name); });
  }
  // Writes the first `fraction` of the bytes of `from` to `to`.
  void cut(const std::string& from, const std::string& to, double fraction) {
    const std::string bytes = read_bytes(folder_ / from);
    folder_.write(to, std::string_view(bytes).substr(0, static_cast<std::size_t>(fraction * bytes.size())));
  }
  test::TemporaryDirectory folder_;
};

TEST_F(ImageFiles, GiveBackWhatWasWritten) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    const cv::Mat image = noise(type);
    write_image(folder_ / "a.png", image);
    const cv::Mat back = read_image(folder_ / "a.png");
    ASSERT_EQ(back.type(), type);
    EXPECT_EQ(cv::norm(image, back, cv::NORM_INF), 0);
    write_image(folder_ / "a.jpg", image);
    EXPECT_EQ(read_image(folder_ / "a.jpg").type(), type);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.png.part"));
}

TEST_F(ImageFiles, KeepSixteenBitsOfDepth) {
  const cv::Mat depth = noise(CV_16UC1);
  write_image(folder_ / "d.png", depth);
  EXPECT_EQ(cv::norm(depth, read_depth(folder_ / "d.png"), cv::NORM_INF), 0);
  EXPECT_EQ(message("d.png"), "d.png: has not 8 bits per channel; convert the image to 8 bits");
  write_image(folder_ / "c.png", noise(CV_8UC3));
  EXPECT_EQ(test::message_of(folder_.path(), [&] { read_depth(folder_ / "c.png"); }),
            "c.png: is no depth image; 16 bits and one channel are wanted");
}

TEST_F(ImageFiles, ThatAreCutOffAreNotReadAsGrey) {
  write_image(folder_ / "a.jpg", noise(CV_8UC3));
  write_image(folder_ / "a.png", noise(CV_8UC3));
  for (const double fraction : {0.1, 0.5, 0.9, 0.999}) {
    cut("a.jpg", "cut.jpg", fraction);
    EXPECT_EQ(message("cut.jpg"), "cut.jpg: is a JPEG that is cut off; copy the file again") << fraction;
    cut("a.png", "cut.png", fraction);
    EXPECT_EQ(message("cut.png"), "cut.png: is a PNG that is cut off; copy the file again") << fraction;
  }
}

TEST_F(ImageFiles, AreDecodedAsOpenCvDoes) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    write_image(folder_ / "a.jpg", noise(type));
    const cv::Mat theirs = cv::imread(folder_ / "a.jpg", cv::IMREAD_ANYCOLOR);
    const cv::Mat ours = read_image(folder_ / "a.jpg");
    ASSERT_EQ(ours.type(), theirs.type());
    EXPECT_EQ(cv::norm(ours, theirs, cv::NORM_INF), 0);
  }
}

TEST_F(ImageFiles, ThatAreDamagedInTheMiddleAreNotReadAsGarbage) {
  write_image(folder_ / "a.jpg", noise(CV_8UC3));
  write_image(folder_ / "a.png", noise(CV_8UC3));
  std::string jpeg = read_bytes(folder_ / "a.jpg"), png = read_bytes(folder_ / "a.png");
  jpeg.at(jpeg.size() / 2) = '\xFF';  // a restart where code should be
  jpeg.at(jpeg.size() / 2 + 1) = '\xD3';
  png[png.size() / 2] ^= 1;
  folder_.write("b.jpg", jpeg);
  folder_.write("b.png", png);
  EXPECT_EQ(message("b.jpg").substr(0, 26), "b.jpg: is a damaged JPEG: ") << message("b.jpg");
  EXPECT_EQ(message("b.png"), "b.png: is a damaged PNG; copy the file again");
  jpeg = read_bytes(folder_ / "a.jpg");
  jpeg.erase(jpeg.size() / 2, 300);
  folder_.write("b.jpg", jpeg);
  EXPECT_EQ(message("b.jpg").substr(0, 26), "b.jpg: is a damaged JPEG: ") << message("b.jpg");
}

TEST_F(ImageFiles, ThatEndInAThumbnailAreStillCutOff) {
  // An APP1 segment of 6 bytes that holds an end-of-image marker, then nothing.
  EXPECT_TRUE(find_image_damage(std::string_view("\xFF\xD8\xFF\xE1\x00\x06\xFF\xD9\x00\x00", 10)));
}

TEST_F(ImageFiles, ThatAreMissingEmptyOrSomethingElseAreNamed) {
  EXPECT_EQ(message("none.jpg"), "none.jpg: cannot be opened: No such file or directory; check the name");
  folder_.write("empty.jpg", "");
  EXPECT_EQ(message("empty.jpg"), "empty.jpg: is empty, an image is wanted; copy the file again");
  folder_.write("poem.jpg", "The time has come");
  EXPECT_EQ(message("poem.jpg"), "poem.jpg: is no readable image; PNG, JPEG, BMP, PNM, TIFF or WebP is wanted");
}

TEST_F(ImageFiles, AreRefusedUnderAnotherEnding) {
  EXPECT_THROW(write_image(folder_ / "a.gif", noise(CV_8UC1)), std::invalid_argument);
  EXPECT_THROW(write_image(folder_ / "a.png", cv::Mat()), std::invalid_argument);
}

TEST_F(ImageFiles, TellOfAFullDisk) {
  std::filesystem::create_symlink("/dev/full", folder_ / "a.png.part");
  EXPECT_EQ(test::message_of(folder_.path(), [&] { write_image(folder_ / "a.png", noise(CV_8UC1)); }),
            "a.png: cannot be written: No space left on device; free some space and run it again");
}

}  // namespace
}  // namespace alidade
