// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/errors.h"

namespace alidade::test {

/// The message of the InputError or DeviceError that `work` throws, without the folder in front of the file's name;
/// "(nothing thrown)" where it throws none.
template <typename Work>
std::string message_of(const std::filesystem::path& folder, Work work) {
  std::string message = "(nothing thrown)";
  try {
    work();
  } catch (const InputError& e) {
    message = e.what();
  } catch (const DeviceError& e) {
    message = e.what();
  }
  const std::string prefix = folder.string() + "/";
  for (std::size_t at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) {
    message.erase(at, prefix.size());
  }
  return message;
}

}  // namespace alidade::test
