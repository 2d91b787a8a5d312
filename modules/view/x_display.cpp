// SPDX-License-Identifier: Apache-2.0
#include "view/x_display.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <utility>

#include <GL/glx.h>
#include <X11/Xlib.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace alidade {
namespace {

// Between fork and exec only what is safe in a program with threads. Descriptor 3 is where the server tells its number.
[[noreturn]] void become_xvfb(int telling) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int nothing = open("/dev/null", O_RDWR);
  for (int stream : {0, 1, 2}) dup2(nothing, stream);
  if (telling == 3) {
    fcntl(3, F_SETFD, 0);  // keep it across exec; dup2 onto itself would not
  } else {
    dup2(telling, 3);
  }
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  execlp("Xvfb", "Xvfb", "-displayfd", "3", "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-noreset",
         "+extension", "GLX", static_cast<char*>(nullptr));
  _exit(127);
}

// The display number that the server writes once it listens; empty where it dies or is silent for ten seconds.
std::string read_number(int listening) {
  constexpr int kPatience_ms = 10000;
  std::string number;
  pollfd waiting{listening, POLLIN, 0};
  for (;;) {
    const int ready = poll(&waiting, 1, kPatience_ms);
    if (ready < 0 && errno == EINTR) continue;
    char c = 0;
    if (ready <= 0 || read(listening, &c, 1) != 1) return {};
    if (c == '\n') return number;
    number += c;
  }
}

void end_server(int server) {
  kill(server, SIGTERM);
  while (waitpid(server, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace

void* XDisplay::connect(const char* name) {
  Display* display = XOpenDisplay(name);
  if (display == nullptr) return nullptr;
  int error_base = 0, event_base = 0;
  if (glXQueryExtension(display, &error_base, &event_base) != 0) return display;
  XCloseDisplay(display);
  return nullptr;
}

std::optional<XDisplay> XDisplay::open_users() {
  void* display = connect(nullptr);
  if (display == nullptr) return std::nullopt;
  return XDisplay(display, -1);
}

std::optional<XDisplay> XDisplay::start_private() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  const int server = fork();
  if (server == 0) become_xvfb(ends[1]);
  close(ends[1]);
  const std::string number = server > 0 ? read_number(ends[0]) : std::string();
  close(ends[0]);
  if (server < 0) return std::nullopt;
  void* display = number.empty() ? nullptr : connect((":" + number).c_str());
  if (display != nullptr) return XDisplay(display, server);
  end_server(server);
  return std::nullopt;
}

XDisplay::XDisplay(XDisplay&& other) noexcept
    : display_(std::exchange(other.display_, nullptr)), server_(std::exchange(other.server_, -1)) {}

XDisplay::~XDisplay() {
  if (display_ != nullptr) XCloseDisplay(static_cast<Display*>(display_));
  if (server_ > 0) end_server(server_);
}

}  // namespace alidade
