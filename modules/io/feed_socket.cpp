// SPDX-License-Identifier: Apache-2.0
#include "io/feed_socket.h"

#include <cerrno>
#include <memory>
#include <string>
#include <system_error>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/errors.h"

namespace alidade {
namespace {

constexpr int kBacklog = 16;
constexpr int kSendBytes = 1 << 17;  // what the system holds for a slow reader is old when it is read

using AddressList = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

AddressList resolve(const FeedAddress& address) {
  const bool is_tcp = address.kind == FeedAddress::Kind::Tcp;
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = is_tcp ? SOCK_STREAM : SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV | (is_tcp ? AI_PASSIVE : 0);
  const bool everywhere = address.host == "*";
  if (everywhere) hints.ai_family = AF_INET;
  const std::string host = address.host.empty() ? "127.0.0.1" : address.host;
  addrinfo* found = nullptr;
  const int error =
      getaddrinfo(everywhere ? nullptr : host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
  if (error == 0) return {found, freeaddrinfo};
  const std::string reason = error == EAI_SYSTEM ? std::generic_category().message(errno) : gai_strerror(error);
  throw DeviceError(to_string(address), "resolve the name", reason, "check the name, or give the address in numbers");
}

OpenFile open_socket(const addrinfo& at) {
  return OpenFile(::socket(at.ai_family, at.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, at.ai_protocol));
}

void switch_on(const OpenFile& socket, int level, int option) {
  const int on = 1;
  ::setsockopt(socket.number(), level, option, &on, sizeof on);
}

[[noreturn]] void fail(const FeedAddress& address, const std::string& operation, int error) {
  std::string remedy = "check the address";
  if (error == EADDRINUSE) remedy = "give another port, or end the program that has this one";
  if (error == EADDRNOTAVAIL) remedy = "give an address of this machine";
  if (error == EACCES) remedy = "give a port above 1023";
  throw DeviceError(to_string(address), operation, std::generic_category().message(error), remedy);
}

}  // namespace

OpenFile::~OpenFile() {
  if (number_ >= 0) ::close(number_);
}

OpenFile listen_at(const FeedAddress& address) {
  const AddressList found = resolve(address);
  int error = 0;
  for (const addrinfo* at = found.get(); at; at = at->ai_next) {
    OpenFile socket = open_socket(*at);
    switch_on(socket, SOL_SOCKET, SO_REUSEADDR);  // connections of an earlier run that linger do not matter
    const bool listens =
        socket && ::bind(socket.number(), at->ai_addr, at->ai_addrlen) == 0 && ::listen(socket.number(), kBacklog) == 0;
    if (listens) return socket;
    error = errno;
  }
  fail(address, "listen", error);
}

int port_of(const OpenFile& listener) {
  sockaddr_storage name{};
  socklen_t size = sizeof name;
  ::getsockname(listener.number(), reinterpret_cast<sockaddr*>(&name), &size);
  if (name.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6&>(name).sin6_port);
  return ntohs(reinterpret_cast<const sockaddr_in&>(name).sin_port);
}

OpenFile accept_reader(const OpenFile& listener) {
  OpenFile reader(::accept4(listener.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!reader) return reader;
  switch_on(reader, IPPROTO_TCP, TCP_NODELAY);
  ::setsockopt(reader.number(), SOL_SOCKET, SO_SNDBUF, &kSendBytes, sizeof kSendBytes);
  return reader;
}

OpenFile open_udp(const FeedAddress& address) {
  const AddressList found = resolve(address);
  int error = 0;
  for (const addrinfo* at = found.get(); at; at = at->ai_next) {
    OpenFile socket = open_socket(*at);
    if (socket && ::connect(socket.number(), at->ai_addr, at->ai_addrlen) == 0) return socket;
    error = errno;
  }
  fail(address, "send", error);
}

}  // namespace alidade
