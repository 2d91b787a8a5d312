// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "capture/frame_source.h"

namespace alidade {

/// A source that gives the frames of `source` in the same order, but reads up to `capacity` of them ahead in a thread
/// of its own. An exception of `source` comes out of next() in its place. `source` is read by that thread only.
std::unique_ptr<FrameSource> read_ahead(std::unique_ptr<FrameSource> source, std::size_t capacity = 8);

}  // namespace alidade
