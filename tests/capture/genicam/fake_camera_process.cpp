// SPDX-License-Identifier: Apache-2.0
#include "fake_camera_process.h"

#include <array>
#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "capture/genicam/gvcp.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

pid_t spawn_silent(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const bool is_spawned = posix_spawnp(&process, arguments[0], &files, nullptr, arguments.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&files);
  return is_spawned ? process : 0;
}

bool answers() {
  return ask_gige_camera(FakeCameraProcess::address(), 100ms).has_value();
}

}  // namespace

FakeCameraProcess::FakeCameraProcess(int lost_packets_per_mille) : lost_packets_per_mille_(lost_packets_per_mille) {
  restart();
}

void FakeCameraProcess::kill() {
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  process_ = 0;
}

void FakeCameraProcess::restart() {
  kill();
  if (answers()) return;  // somebody else's camera
  process_ = spawn_silent(
      {"arv-fake-gv-camera-0.8", "-i", address(), "-s", serial(), "-r", std::to_string(lost_packets_per_mille_)});
  for (int i = 0; i < 100 && process_ > 0 && !answers(); ++i) std::this_thread::sleep_for(20ms);
  if (!answers()) kill();
}

void FakeCameraProcess::stop() {
  ::kill(process_, SIGSTOP);
  waitpid(process_, nullptr, WUNTRACED);  // until it does
}

void FakeCameraProcess::go_on() {
  ::kill(process_, SIGCONT);
}

}  // namespace alidade
