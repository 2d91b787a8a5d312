// SPDX-License-Identifier: Apache-2.0
#include "view/canvas.h"

#include <array>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

constexpr Rgb kBlack{0, 0, 0};

// Darkness-weighted mean position of what was drawn in black on white.
cv::Point2d centroid(const cv::Mat& bgr) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  const cv::Moments m = cv::moments(255 - grey);
  return {m.m10 / m.m00, m.m01 / m.m00};
}

double darkness(const cv::Mat& bgr) {
  return cv::sum(255 - bgr)[0] / 255;
}

TEST(Canvas, PutsADiscWhereItIsToldToAFractionOfAPixel) {
  for (int supersampling : {1, 2, 3}) {
    for (const cv::Point2d centre : {cv::Point2d{20.0, 30.0}, {20.25, 30.5}, {19.6, 30.75}}) {
      Canvas canvas({50, 60}, palette::kPaper, supersampling);
      canvas.draw_disc(centre, 6, kBlack);
      const cv::Point2d found = centroid(canvas.picture());
      EXPECT_NEAR(found.x, centre.x, 0.08) << supersampling;
      EXPECT_NEAR(found.y, centre.y, 0.08) << supersampling;
    }
  }
}

TEST(Canvas, KeepsCoordinatesUnderARestriction) {
  Canvas canvas({50, 60}, palette::kPaper, 2);
  canvas.restrict_to({10, 10, 30, 30});
  canvas.draw_disc({22, 24}, 5, kBlack);
  EXPECT_NEAR(centroid(canvas.picture()).x, 22, 0.08);
  EXPECT_NEAR(centroid(canvas.picture()).y, 24, 0.08);
}

TEST(Canvas, DrawsNothingOutsideARestriction) {
  Canvas canvas({50, 60}, palette::kPaper, 2);
  canvas.restrict_to({10, 10, 30, 30});
  canvas.draw_line({0, 5}, {50, 5}, {kBlack, 3});
  canvas.draw_disc({45, 50}, 4, kBlack);
  EXPECT_EQ(darkness(canvas.picture()), 0);
  canvas.draw_line({0, 20}, {50, 20}, {kBlack, 1});
  EXPECT_NEAR(darkness(canvas.picture()), 30, 12);
}

TEST(Canvas, SurvivesCoordinatesBeyondAnyPicture) {
  Canvas canvas({50, 60}, palette::kPaper, 2);
  canvas.draw_line({-1e300, 30}, {1e300, 30}, {kBlack, 1});
  EXPECT_NEAR(darkness(canvas.picture()), 50, 18);
  canvas.draw_line({0, 0}, {1e12, 0}, {kBlack, 1, true});
}

TEST(Canvas, DashesCoverSevenTwelfthsOfALine) {
  const auto drawn = [](bool dashed) {
    Canvas canvas({480, 20}, palette::kPaper, 2);
    canvas.draw_polyline(std::array<cv::Point2d, 3>{{{0, 10}, {200, 10}, {480, 10}}}, {kBlack, 1, dashed});
    return darkness(canvas.picture());
  };
  EXPECT_NEAR(drawn(true) / drawn(false), 7.0 / 12.0, 0.1);  // the ends of the dashes are round
}

TEST(Canvas, LinesAreAsWideAsAskedToAPixelOfTheLargerPicture) {
  for (int supersampling : {1, 2, 3}) {
    for (double width : {1.5, 2.0, 3.0, 4.5}) {
      Canvas canvas({100, 40}, palette::kPaper, supersampling);
      canvas.draw_line({-50, 20}, {150, 20}, {kBlack, width});
      EXPECT_NEAR(darkness(canvas.picture()) / 100, width, 1.05 / supersampling) << supersampling;
    }
  }
}

TEST(Canvas, EllipseHasItsAxesAndAngle) {
  Canvas canvas({100, 100}, palette::kPaper, 2);
  canvas.draw_ellipse({50, 50}, {30, 10}, 0.5, {kBlack, 1});
  cv::Mat grey;
  cv::cvtColor(canvas.picture(), grey, cv::COLOR_BGR2GRAY);
  const cv::Moments m = cv::moments(255 - grey);
  EXPECT_NEAR(0.5 * std::atan2(2 * m.mu11, m.mu20 - m.mu02), 0.5, 0.02);
  const cv::Mat& picture = canvas.picture();
  const cv::Point end(int(std::lround(50 + 30 * std::cos(0.5))), int(std::lround(50 + 30 * std::sin(0.5))));
  EXPECT_LT(picture.at<cv::Vec3b>(end)[0], 200);
}

TEST(Canvas, TintMixesColours) {
  Canvas canvas({20, 20}, palette::kPaper, 2);
  canvas.tint({5, 5, 10, 100}, {55, 155, 255}, 0.5);
  const cv::Mat picture = canvas.picture();
  EXPECT_EQ(picture.at<cv::Vec3b>(10, 10), cv::Vec3b(255, 205, 155));
  EXPECT_EQ(picture.at<cv::Vec3b>(2, 2), cv::Vec3b(255, 255, 255));
}

TEST(Canvas, AnchorsTextLeftCentreAndRight) {
  const TextFont font{16};
  const auto drawn = [&](Anchor anchor, bool upwards) {
    Canvas canvas({200, 200}, palette::kPaper, 2);
    canvas.write("HHHHHH", {100, 100}, {font, kBlack, anchor, upwards});
    return centroid(canvas.picture());
  };
  const double half = text_size("HHHHHH", font).width / 2.0;
  EXPECT_NEAR(drawn(Anchor::Centre, false).x, 100, 1.0);
  EXPECT_NEAR(drawn(Anchor::Left, false).x, 100 + half, 1.5);
  EXPECT_NEAR(drawn(Anchor::Right, false).x, 100 - half, 1.5);
  EXPECT_NEAR(drawn(Anchor::Centre, false).y, 100, 3.0);
  EXPECT_NEAR(drawn(Anchor::Left, true).y, 100 - half, 1.5);
}

TEST(Canvas, LeavesThePictureItIsGivenAlone) {
  const cv::Mat frame(20, 20, CV_8UC3, cv::Scalar::all(90));
  Canvas canvas(frame);
  canvas.draw_disc({10, 10}, 5, kBlack);
  EXPECT_EQ(cv::countNonZero(frame.reshape(1) != 90), 0);
  EXPECT_NE(cv::countNonZero(canvas.picture().reshape(1) != 90), 0);
}

}  // namespace
}  // namespace alidade
