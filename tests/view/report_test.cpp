// SPDX-License-Identifier: Apache-2.0
#include "view/report.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "core/errors.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(RenderHtml, EscapesEveryText) {
  const std::string evil = "<script>&\"'";
  Report report;
  report.title = report.options = evil;
  report.arguments = report.warnings = {evil};
  report.summary = {{evil, evil, evil, Verdict::Good, evil}};
  report.links = {{evil, evil}};
  report.sections = {{evil, {evil}, {}, {{cv::Mat::zeros(2, 2, CV_8UC1), evil, FigureFormat::Png}}}};
  const std::string html = render_html(report);
  EXPECT_FALSE(contains(html, "<script>"));
  EXPECT_FALSE(contains(html, "&\"'"));
  int found = 0;
  for (std::size_t at = 0; (at = html.find("&lt;script&gt;&amp;&quot;", at)) != std::string::npos; ++at) ++found;
  EXPECT_EQ(found, 16);  // title 2, argument, warning, options, row 4, link 3, section 2, caption 2
}

TEST(RenderHtml, FetchesNothing) {
  Report report;
  report.title = "t";
  const std::string html = render_html(report);
  EXPECT_FALSE(contains(html, "http:"));
  EXPECT_FALSE(contains(html, "https:"));
  EXPECT_FALSE(contains(html, "url("));
}

// The bytes behind the first "base64," of a page.
std::vector<unsigned char> embedded(const std::string& html) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  unsigned bits = 0;
  int count = 0;
  for (std::size_t i = html.find("base64,") + 7; html[i] != '"' && html[i] != '='; ++i) {
    bits = bits << 6 | static_cast<unsigned>(digits.find(html[i]));
    if (++count % 4 == 0) {
      for (int shift : {16, 8, 0}) bytes.push_back(bits >> shift & 255);
      bits = 0;
    }
  }
  if (count % 4 >= 2) bytes.push_back(bits >> (count % 4 == 2 ? 4 : 10) & 255);
  if (count % 4 == 3) bytes.push_back(bits >> 2 & 255);
  return bytes;
}

TEST(RenderHtml, EmbedsPicturesWithoutLoss) {
  for (int width : {3, 4, 5, 6, 7}) {  // PNG sizes that leave 0, 1 and 2 bytes beyond a triple
    cv::Mat image(4, width, CV_8UC3);
    cv::theRNG().state = 5;
    cv::randu(image, 0, 255);
    Report report;
    report.sections = {{"", {}, {}, {{image, "a", FigureFormat::Png}}}};
    const cv::Mat back = cv::imdecode(embedded(render_html(report)), cv::IMREAD_COLOR);
    ASSERT_EQ(back.size(), image.size());
    EXPECT_EQ(cv::norm(back, image, cv::NORM_INF), 0);
  }
}

TEST(RenderHtml, QuotesTheCommandLineForTheShell) {
  Report report;
  report.arguments = {"alidade", "track", "my video.mp4", "it's", ""};
  EXPECT_TRUE(
      contains(render_html(report), "alidade track &#39;my video.mp4&#39; &#39;it&#39;\\&#39;&#39;s&#39; &#39;&#39;"));
}

TEST(RenderHtml, RefusesAnImageOfAnotherType) {
  Report report;
  report.sections = {{"", {}, {}, {{cv::Mat::zeros(2, 2, CV_32FC1), "depth", FigureFormat::Png}}}};
  EXPECT_THROW(render_html(report), std::invalid_argument);
}

TEST(WriteReport, LeavesTheFinishedFileOnly) {
  const fs::path folder = fs::path(testing::TempDir()) / "alidade_report_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  Report report;
  report.title = "Camera track";
  write_report(folder / "report.html", report);
  std::ostringstream text;
  text << std::ifstream(folder / "report.html").rdbuf();
  EXPECT_EQ(text.str(), render_html(report));
  EXPECT_FALSE(fs::exists(folder / "report.html.part"));
  fs::remove_all(folder);
}

TEST(WriteReport, NamesTheFileThatCannotBeWritten) {
  try {
    write_report("/proc/no/such/report.html", Report{});
    FAIL() << "no error";
  } catch (const DeviceError& error) {
    EXPECT_TRUE(contains(error.what(), "/proc/no/such/report.html.part: open: No such file or directory"));
  }
}

}  // namespace
}  // namespace alidade
