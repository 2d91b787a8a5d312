// SPDX-License-Identifier: Apache-2.0
#include "app/progress_display.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

using namespace std::chrono_literals;
using testing::EndsWith;
using testing::HasSubstr;

struct Terminal {
  std::ostringstream out;
  std::ostringstream err;
};

const ProgressDisplay::Clock::time_point kStart{};

TEST(ProgressDisplay, BarShowsCountsAndTheTimeLeft) {
  Terminal terminal;
  ProgressDisplay display(DisplayStyle::Bar, terminal.out, terminal.err);
  display.show({"tracking", 0, 100, ""}, kStart);
  display.show({"tracking", 25, 100, ""}, kStart + 10s);
  // 25 of 100 in 10 s: the other 75 need 30 s. A quarter of 24 cells is six.
  EXPECT_THAT(terminal.err.str(), EndsWith("tracking [======                  ] 25/100, 30 s left"));
  EXPECT_EQ(terminal.out.str(), "");
}

TEST(ProgressDisplay, BarNeverFillsTheLastColumn) {
  Terminal terminal;
  ProgressDisplay display(DisplayStyle::Bar, terminal.out, terminal.err, 20);
  display.show({"tracking", 1, 100, ""}, kStart);
  EXPECT_EQ(terminal.err.str(), "tracking [         ");
}

TEST(ProgressDisplay, LinesOfOutputEraseTheBarFirst) {
  Terminal terminal;
  {
    ProgressDisplay display(DisplayStyle::Bar, terminal.out, terminal.err);
    display.show({"tracking", 1, 0, ""}, kStart);
    display.warn("focal length looks wrong");
    display.tell("done");
  }
  EXPECT_EQ(terminal.err.str(), "tracking 1\r\x1b[Kwarning: focal length looks wrong\n");
  EXPECT_EQ(terminal.out.str(), "done\n");
}

TEST(ProgressDisplay, LogHasALineAtIntervalsAndForEveryMessageAndEnd) {
  Terminal terminal;
  ProgressDisplay display(DisplayStyle::Lines, terminal.out, terminal.err);
  display.show({"tracking", 0, 4, ""}, kStart);
  display.show({"tracking", 1, 4, ""}, kStart + 1s);  // too soon
  display.show({"tracking", 2, 4, "frame 2 lost"}, kStart + 2s);
  display.show({"tracking", 3, 4, ""}, kStart + 15s);
  display.show({"tracking", 4, 4, ""}, kStart + 16s);
  EXPECT_EQ(terminal.err.str(),
            "tracking 0/4\ntracking 2/4, 2 s left: frame 2 lost\ntracking 3/4, 5 s left\ntracking 4/4\n");
}

TEST(ProgressDisplay, JsonLinesParseEvenWithTextThatIsNotUtf8) {
  Terminal terminal;
  ProgressDisplay display(DisplayStyle::Json, terminal.out, terminal.err);
  display.show({"tracking", 3, 4, "image \xff.png"}, kStart);
  display.tell("a result");
  display.publish({{"rmse_m", 0.5}});
  std::istringstream lines(terminal.out.str());
  std::vector<nlohmann::json> events;
  for (std::string line; std::getline(lines, line);) events.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0]["event"], "progress");
  EXPECT_EQ(events[0]["done"], 3);
  EXPECT_EQ(events[1]["text"], "a result");
  EXPECT_EQ(events[2]["event"], "result");
  EXPECT_EQ(events[2]["rmse_m"], 0.5);
}

TEST(ProgressDisplay, QuietPrintsWarningsOnly) {
  Terminal terminal;
  ProgressDisplay display(DisplayStyle::Quiet, terminal.out, terminal.err);
  display.show({"tracking", 3, 4, "a message"}, kStart);
  display.tell("a result");
  display.publish({{"rmse_m", 0.5}});
  display.warn("a warning");
  EXPECT_EQ(terminal.out.str(), "");
  EXPECT_EQ(terminal.err.str(), "warning: a warning\n");
}

TEST(ProgressDisplay, ALiveFeedIsOnStandardOutputInEveryStyle) {
  for (const auto style : {DisplayStyle::Bar, DisplayStyle::Lines, DisplayStyle::Json, DisplayStyle::Quiet}) {
    Terminal terminal;
    ProgressDisplay display(style, terminal.out, terminal.err);
    display.stream({{"event", "pose"}, {"t_ns", 4}});
    EXPECT_EQ(terminal.out.str(), "{\"event\":\"pose\",\"t_ns\":4}\n");
    EXPECT_EQ(terminal.err.str(), "");
  }
}

}  // namespace
}  // namespace alidade
