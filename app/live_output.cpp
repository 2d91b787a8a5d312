// SPDX-License-Identifier: Apache-2.0
#include "app/live_output.h"

#include <chrono>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/errors.h"

namespace alidade {
namespace {

// Text from file names may not be UTF-8; a replacement character is better than no line.
std::string line_of(const nlohmann::ordered_json& message) {
  return message.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

FeedOptions feed_options(const nlohmann::ordered_json& hello) {
  FeedOptions options;
  options.greeting = line_of(hello);
  options.loss_notice = [](std::uint64_t count) { return line_of({{"type", "lost"}, {"count", count}}); };
  return options;
}

FeedAddress checked_address(const RunContext& context, const std::string& text) {
  const FeedAddress address = parse_feed_address(text);
  if (address.kind == FeedAddress::Kind::StandardOutput && context.prints_json) {
    throw InputError("--stream -", 0, "--json wants standard output too", "give --stream tcp://:PORT, or no --json");
  }
  return address;
}

}  // namespace

bool leaves_standard_output(const std::string& stream_address) {
  return stream_address != "-";
}

LiveOutput::LiveOutput(const RunContext& context, const std::string& address, const nlohmann::ordered_json& hello)
    : feed_(checked_address(context, address), feed_options(hello)), server_([this] { feed_.serve(); }) {
  if (feed_.address().kind == FeedAddress::Kind::Tcp) {
    context.tell(fmt::format("live output at {}", to_string(feed_.address())));
  }
}

LiveOutput::~LiveOutput() {
  finish();
}

std::chrono::steady_clock::time_point LiveOutput::send(nlohmann::ordered_json message) {
  const auto now = std::chrono::steady_clock::now();
  message["sent_ns"] = std::chrono::nanoseconds(now.time_since_epoch()).count();
  feed_.send(line_of(message));
  return now;
}

FeedTally LiveOutput::end(nlohmann::ordered_json message) {
  send(std::move(message));
  finish();
  return feed_.tally();
}

void LiveOutput::finish() {
  if (!server_.joinable()) return;
  feed_.close();
  server_.join();
}

}  // namespace alidade
