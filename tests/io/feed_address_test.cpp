// SPDX-License-Identifier: Apache-2.0
#include "io/feed_address.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"

namespace alidade {
namespace {

using Kind = FeedAddress::Kind;

std::string fault_of(const std::string& text) {
  return test::message_of("/nowhere", [&] { parse_feed_address(text); });
}

TEST(FeedAddress, IsAWayAHostAndAPort) {
  EXPECT_EQ(parse_feed_address("-"), FeedAddress{});
  EXPECT_EQ(parse_feed_address("tcp://:5555"), (FeedAddress{Kind::Tcp, "", 5555}));
  EXPECT_EQ(parse_feed_address("tcp://*:0"), (FeedAddress{Kind::Tcp, "*", 0}));
  EXPECT_EQ(parse_feed_address("udp://render.local:65535"), (FeedAddress{Kind::Udp, "render.local", 65535}));
  EXPECT_EQ(parse_feed_address("tcp://[::1]:80"), (FeedAddress{Kind::Tcp, "::1", 80}));
}

TEST(FeedAddress, ReadsBackItsText) {
  for (const char* text : {"-", "tcp://127.0.0.1:5555", "udp://render.local:1", "tcp://[::1]:80", "tcp://*:0"}) {
    EXPECT_EQ(to_string(parse_feed_address(text)), text);
  }
  EXPECT_EQ(to_string(parse_feed_address("tcp://:5555")), "tcp://127.0.0.1:5555");
}

TEST(FeedAddress, SaysWhatIsWrong) {
  const std::string remedy = "; give tcp://ADDR:PORT (readers connect), udp://ADDR:PORT, or - for standard output";
  EXPECT_EQ(fault_of("localhost:5"), "localhost:5: is no address for live output: it names no way to go" + remedy);
  EXPECT_EQ(fault_of(""), ": is no address for live output: it names no way to go" + remedy);
  EXPECT_EQ(fault_of("tcp://host"), "tcp://host: is no address for live output: the port is missing" + remedy);
  EXPECT_EQ(fault_of("tcp://[::1]"), "tcp://[::1]: is no address for live output: the port is missing" + remedy);
  EXPECT_EQ(fault_of("tcp://::1:80"),
            "tcp://::1:80: is no address for live output: an IPv6 number stands in brackets" + remedy);
  EXPECT_EQ(fault_of("tcp://:70000"),
            "tcp://:70000: is no address for live output: the port must be 0..65535, got '70000'" + remedy);
  EXPECT_EQ(fault_of("tcp://:80x"),
            "tcp://:80x: is no address for live output: the port must be 0..65535, got '80x'" + remedy);
  EXPECT_EQ(fault_of("udp://host:0"),
            "udp://host:0: is no address for live output: the port must be 1..65535, got '0'" + remedy);
  EXPECT_EQ(fault_of("udp://*:5"), "udp://*:5: is no address for live output: datagrams go to one address" + remedy);
}

}  // namespace
}  // namespace alidade
