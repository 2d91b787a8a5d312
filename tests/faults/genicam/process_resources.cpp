// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/genicam/process_resources.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include <malloc.h>
#include <unistd.h>

namespace alidade::test {
namespace {

int entries_of(const char* folder) {
  return static_cast<int>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

}  // namespace

ProcessResources process_resources() {
  ::malloc_trim(0);  // what the allocator keeps for later is no leak
  long total_pages = 0;
  long resident_pages = 0;
  std::ifstream("/proc/self/statm") >> total_pages >> resident_pages;
  return {.descriptors = entries_of("/proc/self/fd"),
          .threads = entries_of("/proc/self/task"),
          .resident_mb = static_cast<double>(resident_pages * ::sysconf(_SC_PAGESIZE)) / 1e6};
}

ProcessResources settled_resources(const ProcessResources& allowed, std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(50))) {
    const ProcessResources now = process_resources();
    const bool is_settled = now.descriptors <= allowed.descriptors && now.threads <= allowed.threads;
    if (is_settled || std::chrono::steady_clock::now() > end) return now;
  }
}

}  // namespace alidade::test
