// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace alidade {

/// Runs `release` in a thread of its own, for what takes seconds and nobody waits for. The end of the program waits for
/// all of them, but a second at most.
void release_in_background(std::function<void()> release);

/// How many still run.
int background_releases();

}  // namespace alidade
