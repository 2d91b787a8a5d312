// SPDX-License-Identifier: Apache-2.0
#include "app/capture_warnings.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(CaptureWarnings, TellOfALossAndOfItsEndButNotOfEachFrame) {
  RunContext context;
  std::vector<std::string> warnings;
  context.warn = [&](const std::string& line) { warnings.push_back(line); };
  const CaptureEventSink sink = warn_of_news(context);
  using Kind = CaptureEventKind;
  for (const Kind kind : {Kind::Opened, Kind::Streaming, Kind::FramesDropped, Kind::FrameDamaged, Kind::Disconnected,
                          Kind::Opened, Kind::Streaming, Kind::Streaming, Kind::Closed}) {
    sink({kind, {}, "cam", 7, kind == Kind::Disconnected ? "unplugged" : ""});
  }
  EXPECT_EQ(warnings,
            (std::vector<std::string>{"cam: disconnected before frame 7: unplugged", "cam: streaming before frame 7"}));
}

}  // namespace
}  // namespace alidade
