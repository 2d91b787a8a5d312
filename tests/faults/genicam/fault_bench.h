// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "capture/camera_device.h"
#include "tests/faults/genicam/figure.h"
#include "tests/support/gige_camera/camera_process.h"

namespace alidade::test {

/// What the sections of the suite share: the test camera's program, two addresses of this machine, how long to try.
struct FaultBench {
  std::filesystem::path camera_program;
  std::filesystem::path folder;  ///< for logs
  std::string address = "127.0.0.31";
  std::string other_address = "127.0.0.32";
  int cycles = 3;                           ///< of faults that are tried again and again
  int frames = 200;                         ///< of a run in which packets are lost
  double clocks_s = 6;                      ///< of a run in which clocks are compared
  std::vector<double> losses{0.005, 0.02};  ///< shares of packets

  /// Starts the camera there, its log in `log_of(address)`.
  std::unique_ptr<CameraProcess> start_camera(const std::string& where, std::vector<std::string> arguments = {}) const;
  std::filesystem::path log_of(const std::string& where) const { return folder / (where + ".csv"); }
};

/// Small frames at `fps_hz`, in packets of 1500 bytes.
CameraRequest small_request(double fps_hz);

/// The sections, each as its name says.
Figures kill_figures(const FaultBench& bench);
Figures freeze_figures(const FaultBench& bench);
Figures stall_figures(const FaultBench& bench);
Figures busy_figures(const FaultBench& bench);
Figures loss_figures(const FaultBench& bench);
Figures drop_figures(const FaultBench& bench);
Figures clock_figures(const FaultBench& bench);
Figures trigger_figures(const FaultBench& bench);
Figures format_figures(const FaultBench& bench);

}  // namespace alidade::test
