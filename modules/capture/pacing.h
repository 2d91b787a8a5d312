// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "capture/frame_source.h"

namespace alidade {

/// The frames of `source` no earlier than they came in life: each as long after the first, on the host's clock, as its
/// time is after the first one's. A reader that is too slow gets them late, none is left out. All at once where the
/// source has no times.
std::unique_ptr<FrameSource> in_real_time(std::unique_ptr<FrameSource> source);

}  // namespace alidade
