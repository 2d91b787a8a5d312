// SPDX-License-Identifier: Apache-2.0
#include "io/feed_address.h"

#include <charconv>
#include <string_view>

#include <fmt/format.h>

#include "core/errors.h"

namespace alidade {
namespace {

constexpr int kMostPort = 65535;

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw InputError(text, 0, "is no address for live output: " + why,
                   "give tcp://ADDR:PORT (readers connect), udp://ADDR:PORT, or - for standard output");
}

int parse_port(const std::string& text, std::string_view digits, int least) {
  int port = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  const bool whole = error == std::errc{} && end == digits.data() + digits.size();
  if (whole && port >= least && port <= kMostPort) return port;
  refuse(text, fmt::format("the port must be {}..{}, got '{}'", least, kMostPort, digits));
}

}  // namespace

FeedAddress parse_feed_address(const std::string& text) {
  if (text == "-") return {};
  FeedAddress address;
  if (text.starts_with("tcp://")) {
    address.kind = FeedAddress::Kind::Tcp;
  } else if (text.starts_with("udp://")) {
    address.kind = FeedAddress::Kind::Udp;
  } else {
    refuse(text, "it names no way to go");
  }
  const std::string_view place = std::string_view(text).substr(6);
  const auto colon = place.rfind(':');
  const bool has_port = colon != std::string_view::npos && !place.ends_with(']');
  if (!has_port) refuse(text, "the port is missing");
  std::string_view host = place.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    refuse(text, "an IPv6 number stands in brackets");
  }
  address.host = host;
  const bool is_udp = address.kind == FeedAddress::Kind::Udp;
  if (is_udp && host == "*") refuse(text, "datagrams go to one address");
  address.port = parse_port(text, place.substr(colon + 1), is_udp ? 1 : 0);
  return address;
}

std::string to_string(const FeedAddress& address) {
  if (address.kind == FeedAddress::Kind::StandardOutput) return "-";
  const std::string scheme = address.kind == FeedAddress::Kind::Tcp ? "tcp" : "udp";
  const bool is_v6 = address.host.find(':') != std::string::npos;
  const std::string host = address.host.empty() ? "127.0.0.1" : is_v6 ? '[' + address.host + ']' : address.host;
  return fmt::format("{}://{}:{}", scheme, host, address.port);
}

}  // namespace alidade
