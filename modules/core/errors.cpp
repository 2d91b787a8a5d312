// SPDX-License-Identifier: Apache-2.0
#include "core/errors.h"

#include <utility>

#include <fmt/format.h>

namespace alidade {
namespace {

std::string place(const std::string& path, int line) {
  return line > 0 ? fmt::format("{}:{}", path, line) : path;
}

std::string with_remedy(std::string text, const std::string& remedy) {
  return remedy.empty() ? text : fmt::format("{}; {}", text, remedy);
}

}  // namespace

InputError::InputError(std::string path, int line, std::string what, std::string remedy)
    : std::runtime_error(with_remedy(fmt::format("{}: {}", place(path, line), what), remedy)),
      path_(std::move(path)),
      line_(line),
      remedy_(std::move(remedy)) {}

DeviceError::DeviceError(std::string device, std::string operation, std::string reason, std::string remedy)
    : std::runtime_error(with_remedy(fmt::format("{}: {}: {}", device, operation, reason), remedy)),
      device_(std::move(device)) {}

}  // namespace alidade
