// SPDX-License-Identifier: Apache-2.0
#include "io/line_feed.h"

#include <algorithm>
#include <csignal>
#include <stdexcept>
#include <vector>

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace alidade {
namespace {

constexpr std::size_t kMostReaders = 64;  // others wait until one has gone
constexpr auto kGreetEvery = std::chrono::seconds(1);
constexpr int kRetryMs = 100;  // where a reader waits and the system has no descriptor left for it

void block_broken_pipe_signal() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

}  // namespace

LineFeed::LineFeed(const FeedAddress& address, FeedOptions options)
    : address_(address),
      options_(std::move(options)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      incoming_(options_.capacity) {
  if (!options_.loss_notice) throw std::invalid_argument("LineFeed: a notice for losses is needed");
  switch (address.kind) {
    case FeedAddress::Kind::Tcp:
      listener_ = listen_at(address);
      address_.port = port_of(listener_);
      break;
    case FeedAddress::Kind::Udp:
      add_reader(open_udp(address));
      break;
    case FeedAddress::Kind::StandardOutput:
      add_reader(OpenFile(::dup(STDOUT_FILENO)));
      break;
  }
}

void LineFeed::send(std::string line) {
  {
    const std::scoped_lock lock(mutex_);
    incoming_.push(std::move(line));
  }
  wake();
}

void LineFeed::close() {
  {
    const std::scoped_lock lock(mutex_);
    closing_ = true;
  }
  wake();
}

void LineFeed::wake() const {
  ::eventfd_write(wake_.number(), 1);
}

void LineFeed::add_reader(OpenFile descriptor) {
  readers_.emplace_back(std::move(descriptor), address_.kind, options_.capacity, options_.loss_notice);
  if (address_.kind != FeedAddress::Kind::Udp) readers_.back().lines().push(options_.greeting);
  ++tally_.readers;
}

// What has come in goes to every reader's own queue. Whether it is closing.
bool LineFeed::hand_out() {
  eventfd_t ignored = 0;
  ::eventfd_read(wake_.number(), &ignored);
  std::vector<std::string> lines;
  std::uint64_t lost = 0;
  bool closing = false;
  {
    const std::scoped_lock lock(mutex_);
    lost = incoming_.take_lost();
    while (auto line = incoming_.pop()) lines.push_back(std::move(*line));
    closing = closing_;
  }
  const bool greets = address_.kind == FeedAddress::Kind::Udp && !lines.empty() &&
                      (!greeted_ || Clock::now() - *greeted_ >= kGreetEvery);
  if (greets) greeted_ = Clock::now();
  for (FeedReader& reader : readers_) {
    reader.lines().add_lost(lost);
    if (greets) reader.lines().push(options_.greeting);
    for (const std::string& line : lines) reader.lines().push(line);
  }
  return closing;
}

void LineFeed::wait_and_serve(int timeout_ms) {
  std::vector<pollfd> waiting{{wake_.number(), POLLIN, 0}};
  for (const FeedReader& reader : readers_) waiting.push_back({reader.descriptor(), reader.wanted_events(), 0});
  const bool has_room = listener_ && readers_.size() < kMostReaders;
  if (has_room) waiting.push_back({listener_.number(), POLLIN, 0});
  ::poll(waiting.data(), waiting.size(), timeout_ms);
  for (std::size_t i = 0; i < readers_.size(); ++i) readers_[i].react(waiting[i + 1].revents);
  const bool somebody_comes = has_room && waiting.back().revents != 0;
  if (!somebody_comes) return;
  if (OpenFile reader = accept_reader(listener_)) {
    add_reader(std::move(reader));
  } else {
    ::poll(nullptr, 0, kRetryMs);
  }
}

void LineFeed::forget_gone() {
  for (const FeedReader& reader : readers_) tally_.lost += reader.is_gone() ? reader.lost() : 0;
  std::erase_if(readers_, [](const FeedReader& reader) { return reader.is_gone(); });
}

bool LineFeed::is_over(bool closing) {
  if (!closing) return false;
  if (!deadline_) deadline_ = Clock::now() + options_.farewell;
  const bool all_served = std::all_of(readers_.begin(), readers_.end(), [](const auto& r) { return r.is_served(); });
  return all_served || Clock::now() >= *deadline_;
}

void LineFeed::serve() {
  block_broken_pipe_signal();
  constexpr int kCheckMs = 20;  // how exactly the farewell ends
  while (true) {
    const bool closing = hand_out();
    forget_gone();
    if (is_over(closing)) break;
    wait_and_serve(closing ? kCheckMs : -1);
  }
  for (const FeedReader& reader : readers_) tally_.lost += reader.lost();
  readers_.clear();
  listener_ = {};
}

}  // namespace alidade
