// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "io/feed_address.h"
#include "io/feed_reader.h"
#include "io/feed_socket.h"
#include "io/line_queue.h"

namespace alidade {

struct FeedOptions {
  std::string greeting;  ///< the first line that every reader gets; of UDP, where nobody connects, one every second
  std::function<std::string(std::uint64_t)> loss_notice;  ///< the line that tells a reader how many it has lost
  std::size_t capacity = 4096;               ///< lines that wait for each reader: 16 s at 250 a second; 4 MB
  std::chrono::milliseconds farewell{1000};  ///< after close(): so long slow readers may take to get the rest
};

/// How a feed went.
struct FeedTally {
  int readers = 0;         ///< that ever were there
  std::uint64_t lost = 0;  ///< lines given up, over all readers
};

/// Lines of text to whoever reads them, while they are made. Who makes them never waits: send() puts a line into a
/// bounded queue, serve(), in a thread of the caller's, brings it to the readers, and one that is slow loses lines and
/// is told how many. A reader that closes is forgotten.
class LineFeed {
 public:
  /// Opens the address. Throws DeviceError as listen_at and open_udp do, std::invalid_argument for no loss_notice.
  LineFeed(const FeedAddress& address, FeedOptions options);

  /// Where it is, with the port that the system chose.
  const FeedAddress& address() const { return address_; }

  /// A line, without its end. From any thread; not after close().
  void send(std::string line);

  /// No more lines will come.
  void close();

  /// Serves the readers until close() was called and all have everything, or the farewell is over. Once, in a thread
  /// that nobody waits for until then. That thread's SIGPIPE is blocked.
  void serve();

  /// Once serve() has returned.
  const FeedTally& tally() const { return tally_; }

 private:
  using Clock = std::chrono::steady_clock;

  void wake() const;
  bool hand_out();
  void add_reader(OpenFile descriptor);
  void wait_and_serve(int timeout_ms);
  void forget_gone();
  bool is_over(bool closing);

  FeedAddress address_;
  FeedOptions options_;
  OpenFile listener_;  // of TCP
  OpenFile wake_;      // an event: there are lines, or it is over
  std::deque<FeedReader> readers_;
  std::optional<Clock::time_point> greeted_, deadline_;
  FeedTally tally_;

  std::mutex mutex_;  // for what follows
  LineQueue incoming_;
  bool closing_ = false;
};

}  // namespace alidade
