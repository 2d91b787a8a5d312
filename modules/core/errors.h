// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace alidade {

/// What is wrong with the user's data: where, what, and how to mend it.
/// what() is the one line for stderr: "path:line: what; remedy" (line 0: the file as a whole).
class InputError : public std::runtime_error {
 public:
  InputError(std::string path, int line, std::string what, std::string remedy);

  const std::string& path() const { return path_; }
  int line() const { return line_; }
  const std::string& remedy() const { return remedy_; }

 private:
  std::string path_;
  int line_;
  std::string remedy_;
};

/// What a device, a display or an output file system refused. what() is "device: operation: reason; remedy".
class DeviceError : public std::runtime_error {
 public:
  DeviceError(std::string device, std::string operation, std::string reason, std::string remedy);

  const std::string& device() const { return device_; }

 private:
  std::string device_;
};

/// The exit codes of the program; they are part of its interface.
enum class ExitCode : int {
  Success = 0,
  Bug = 1,
  BadInput = 2,
  DeviceFault = 3,
  NoAnswer = 4,  ///< the data was read but holds no answer, e.g. no overlap between the images
  WorthRetrying = 75,
  Interrupted = 130,
};

}  // namespace alidade
