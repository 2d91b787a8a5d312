// SPDX-License-Identifier: Apache-2.0
#include "tracking/frame.h"

namespace alidade {

const char* to_string(FrameState state) {
  switch (state) {
    case FrameState::Waiting:
      return "waiting";
    case FrameState::Tracked:
      return "tracked";
    case FrameState::Predicted:
      return "predicted";
    case FrameState::Lost:
      return "lost";
  }
  return "";
}

}  // namespace alidade
