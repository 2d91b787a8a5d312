// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace alidade::test {

/// What this program holds.
struct ProcessResources {
  int descriptors = 0;
  int threads = 0;
  double resident_mb = 0;  ///< 10⁶ bytes
};

ProcessResources process_resources();

/// The same, once no more than `allowed` descriptors and threads are held, or after `patience`: what is let go of in
/// the background takes its time.
ProcessResources settled_resources(const ProcessResources& allowed, std::chrono::milliseconds patience);

}  // namespace alidade::test
