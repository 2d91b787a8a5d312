// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <sys/types.h>

namespace alidade {

/// Aravis' GigE Vision camera in a process of its own, on 127.0.0.1: it answers once constructed, and is killed at the
/// end. The test is to be skipped where `is_running()` is false.
class FakeCameraProcess {
 public:
  explicit FakeCameraProcess(int lost_packets_per_mille = 0);
  FakeCameraProcess(const FakeCameraProcess&) = delete;
  FakeCameraProcess& operator=(const FakeCameraProcess&) = delete;
  ~FakeCameraProcess() { kill(); }

  bool is_running() const { return process_ > 0; }
  static std::string address() { return "127.0.0.1"; }
  static std::string serial() { return "T1"; }

  void kill();     ///< as by kill -9
  void restart();  ///< waits until it answers
  void stop();     ///< it stands still, as a camera without its network does
  void go_on();

 private:
  int lost_packets_per_mille_;
  pid_t process_ = 0;
};

}  // namespace alidade
