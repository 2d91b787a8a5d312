// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace alidade::test {

/// A gige_test_camera of its own, so that it can be stopped and killed. It ends with its owner, and with the thread
/// that started it.
class CameraProcess {
 public:
  /// Starts `program` and waits until it can be used. Throws DeviceError with what it said where it cannot.
  CameraProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments);
  ~CameraProcess();
  CameraProcess(const CameraProcess&) = delete;
  CameraProcess& operator=(const CameraProcess&) = delete;

  /// One of the commands of its --help.
  void command(const std::string& line) const;

  /// As kill -9: nothing is said to anyone.
  void kill();
  /// Stops and continues it, as SIGSTOP and SIGCONT do.
  void freeze() const;
  void thaw() const;
  /// Ends it in order; what it printed after "ready".
  std::string end();

 private:
  std::string read_line() const;
  void reap();

  pid_t process_ = -1;
  int input_ = -1;   // ours to write
  int output_ = -1;  // ours to read
};

}  // namespace alidade::test
