// SPDX-License-Identifier: Apache-2.0
#include "io/line_feed.h"

#include <stdexcept>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/input_error.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

const FeedAddress kAnyPort{FeedAddress::Kind::Tcp, "", 0};

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

// One that reads lines from a loopback socket, and gives up after a second of silence.
class Reader {
 public:
  explicit Reader(const LineFeed& feed, int receive_bytes = 0) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval patience{1, 0};
    ::setsockopt(socket_.number(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (receive_bytes > 0) {
      ::setsockopt(socket_.number(), SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
    }
    const sockaddr_in address = loopback(feed.address().port);
    EXPECT_EQ(::connect(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }

  // The next line; "(end)" where the feed has closed, "(silence)" after a second without one.
  std::string line() {
    while (true) {
      if (const auto end = text_.find('\n'); end != std::string::npos) {
        std::string line = text_.substr(0, end);
        text_.erase(0, end + 1);
        return line;
      }
      char block[4096];
      const ssize_t count = ::recv(socket_.number(), block, sizeof block, 0);
      if (count == 0) return "(end)";
      if (count < 0) return "(silence)";
      text_.append(block, static_cast<std::size_t>(count));
    }
  }

  void finish_speaking() const { ::shutdown(socket_.number(), SHUT_WR); }

 private:
  OpenFile socket_;
  std::string text_;
};

// A feed with its thread.
struct ServedFeed {
  explicit ServedFeed(std::size_t capacity = 4096, const FeedAddress& address = kAnyPort)
      : feed(address, {"hello", [](std::uint64_t n) { return "lost " + std::to_string(n); }, capacity, 300ms}),
        thread([this] { feed.serve(); }) {}
  ~ServedFeed() { end(); }

  void end() {
    if (!thread.joinable()) return;
    feed.close();
    thread.join();
  }

  LineFeed feed;
  std::jthread thread;
};

TEST(LineFeed, GivesAFastReaderAllLinesInOrder) {
  ServedFeed served;
  Reader reader(served.feed);
  ASSERT_EQ(reader.line(), "hello");
  for (int i = 0; i < 2000; ++i) served.feed.send(std::to_string(i));
  for (int i = 0; i < 2000; ++i) ASSERT_EQ(reader.line(), std::to_string(i));
  served.end();
  EXPECT_EQ(reader.line(), "(end)");
  EXPECT_EQ(served.feed.tally().readers, 1);
  EXPECT_EQ(served.feed.tally().lost, 0u);
}

TEST(LineFeed, TellsAStoppedReaderItsLossesAndDoesNotWaitForIt) {
  constexpr int kCount = 20000;
  const std::string filling(1000, '.');
  ServedFeed served(100);
  Reader stopped(served.feed, 4096), fast(served.feed);
  ASSERT_EQ(fast.line(), "hello");
  ASSERT_EQ(stopped.line(), "hello");
  int fast_count = 0;
  const auto begin = Clock::now();
  Clock::duration longest{};
  for (int i = 0; i < kCount; ++i) {
    const auto before = Clock::now();
    served.feed.send(std::to_string(i) + filling);
    longest = std::max(longest, Clock::now() - before);
    if (i % 50 == 49) {  // the other reader keeps up, and is not kept up
      for (int k = 0; k < 50; ++k) fast_count += fast.line() == std::to_string(fast_count) + filling;
    }
  }
  EXPECT_EQ(fast_count, kCount);
  EXPECT_LT(longest, 100ms);
  EXPECT_LT(Clock::now() - begin, 2s);
  served.feed.close();
  int count = 0, losses = 0;
  for (std::string line = stopped.line(); line != "(end)" && line != "(silence)"; line = stopped.line()) {
    if (line.starts_with("lost ")) {
      count += std::stoi(line.substr(5));
      ++losses;
    } else {
      ASSERT_EQ(std::stoi(line), count) << "after " << losses << " losses";
      ++count;
    }
  }
  EXPECT_EQ(count, kCount);
  EXPECT_GT(losses, 0);
  EXPECT_LT(losses, kCount / 100);
}

TEST(LineFeed, LetsReadersComeAndGo) {
  ServedFeed served;
  {
    Reader first(served.feed);
    ASSERT_EQ(first.line(), "hello");
    served.feed.send("a");
    ASSERT_EQ(first.line(), "a");
  }
  for (int i = 0; i < 10; ++i) {  // into a socket that is closed: neither SIGPIPE nor an end of the feed
    served.feed.send("nobody reads");
    std::this_thread::sleep_for(2ms);
  }
  Reader again(served.feed);
  ASSERT_EQ(again.line(), "hello");
  served.feed.send("b");
  EXPECT_EQ(again.line(), "b");
}

TEST(LineFeed, ServesAReaderThatHasNothingMoreToSay) {
  ServedFeed served;
  Reader reader(served.feed);
  ASSERT_EQ(reader.line(), "hello");
  reader.finish_speaking();
  std::this_thread::sleep_for(10ms);
  served.feed.send("a");
  EXPECT_EQ(reader.line(), "a");
}

TEST(LineFeed, WaitsForAReaderAtItsEndAndNotForever) {
  const std::string filling(1000, '.');
  ServedFeed served;
  Reader stopped(served.feed, 4096);
  ASSERT_EQ(stopped.line(), "hello");
  for (int i = 0; i < 2000; ++i) served.feed.send(filling);
  const auto begin = Clock::now();
  served.end();
  EXPECT_GE(Clock::now() - begin, 250ms);
  EXPECT_LT(Clock::now() - begin, 800ms);
}

TEST(LineFeed, NeedsNoReader) {
  ServedFeed served;
  for (int i = 0; i < 10000; ++i) served.feed.send("x");
  const auto begin = Clock::now();
  served.end();
  EXPECT_LT(Clock::now() - begin, 200ms);
  EXPECT_EQ(served.feed.tally().readers, 0);
}

TEST(LineFeed, SendsADatagramPerLineAndGreetsFirst) {
  const OpenFile receiver(::socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in address = loopback(0);
  ASSERT_EQ(::bind(receiver.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  const timeval patience{1, 0};
  ::setsockopt(receiver.number(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ServedFeed served(4096, {FeedAddress::Kind::Udp, "127.0.0.1", port_of(receiver)});
  served.feed.send("a");
  served.feed.send("b");
  for (const char* expected : {"hello\n", "a\n", "b\n"}) {
    char datagram[100];
    const ssize_t count = ::recv(receiver.number(), datagram, sizeof datagram, 0);
    ASSERT_GT(count, 0);
    EXPECT_EQ(std::string(datagram, static_cast<std::size_t>(count)), expected);
  }
}

TEST(LineFeed, DoesNotMindDatagramsThatNobodyTakes) {
  int port = 0;
  {
    const OpenFile taken(::socket(AF_INET, SOCK_DGRAM, 0));
    const sockaddr_in address = loopback(0);
    ASSERT_EQ(::bind(taken.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    port = port_of(taken);
  }
  ServedFeed served(4096, {FeedAddress::Kind::Udp, "127.0.0.1", port});
  for (int i = 0; i < 100; ++i) served.feed.send("x");
  const auto begin = Clock::now();
  served.end();
  EXPECT_LT(Clock::now() - begin, 250ms);
}

TEST(LineFeed, RefusesAPortInUseAndNamesThatDoNotResolve) {
  const LineFeed first(kAnyPort, {"", [](std::uint64_t) { return ""; }});
  const std::string text = to_string(first.address());
  const auto open = [](const std::string& address) {
    return test::message_of("/nowhere", [&] {
      LineFeed(parse_feed_address(address), {"", [](std::uint64_t) { return ""; }});
    });
  };
  EXPECT_EQ(open(text),
            text + ": listen: Address already in use; give another port, or end the program that has this one");
  EXPECT_EQ(open("tcp://192.0.2.1:5555"),
            "tcp://192.0.2.1:5555: listen: Cannot assign requested address; give an address of this machine");
  const std::string unknown = open("udp://no-such-host.invalid:5555");
  EXPECT_TRUE(unknown.starts_with("udp://no-such-host.invalid:5555: resolve the name: ")) << unknown;
  EXPECT_TRUE(unknown.ends_with("; check the name, or give the address in numbers")) << unknown;
}

TEST(LineFeed, NeedsANoticeForLosses) {
  EXPECT_THROW(LineFeed(kAnyPort, {}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
