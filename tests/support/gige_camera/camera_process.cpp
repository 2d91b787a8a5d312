// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/camera_process.h"

#include <csignal>
#include <stdexcept>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/errors.h"

namespace alidade::test {
namespace {

struct Pipe {
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    read = ends[0];
    write = ends[1];
  }
  int read = -1;
  int write = -1;
};

[[noreturn]] void become(const std::vector<std::string>& arguments, int input, int output) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::dup2(input, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  ::execv(argv.front(), argv.data());
  ::_exit(127);
}

}  // namespace

CameraProcess::CameraProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> all{program.string()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Pipe to_it;
  const Pipe from_it;
  process_ = ::fork();
  if (process_ == 0) become(all, to_it.read, from_it.write);
  ::close(to_it.read);
  ::close(from_it.write);
  input_ = to_it.write;
  output_ = from_it.read;
  if (const std::string line = read_line(); !line.starts_with("ready")) {
    kill();
    throw DeviceError(program.string(), "start", "it did not become ready: " + line, "see what it printed above");
  }
}

CameraProcess::~CameraProcess() {
  kill();
  ::close(input_);
  ::close(output_);
}

std::string CameraProcess::read_line() const {
  std::string line;
  char byte = 0;
  while (::read(output_, &byte, 1) == 1 && byte != '\n') line += byte;
  return line;
}

void CameraProcess::command(const std::string& line) const {
  const std::string text = line + "\n";
  if (::write(input_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw DeviceError("gige_test_camera", "command", "it is gone", "");
  }
}

void CameraProcess::reap() {
  if (process_ > 0) ::waitpid(process_, nullptr, 0);
  process_ = -1;
}

void CameraProcess::kill() {
  if (process_ > 0) ::kill(process_, SIGKILL);
  reap();
}

void CameraProcess::freeze() const {
  ::kill(process_, SIGSTOP);
}

void CameraProcess::thaw() const {
  ::kill(process_, SIGCONT);
}

std::string CameraProcess::end() {
  if (process_ > 0) ::kill(process_, SIGTERM);
  const std::string said = read_line();
  reap();
  return said;
}

}  // namespace alidade::test
