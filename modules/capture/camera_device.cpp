// SPDX-License-Identifier: Apache-2.0
#include "capture/camera_device.h"

namespace alidade {

std::chrono::nanoseconds stamp_to_middle(const CameraFacts& facts) {
  const std::chrono::nanoseconds half = facts.exposure.value_or(std::chrono::nanoseconds(0)) / 2;
  switch (facts.stamped) {
    case StampedMoment::ExposureStart:
      return half;
    case StampedMoment::ReadoutEnd:  // the readout's own time is told by no driver
      return -half;
    case StampedMoment::Unknown:
      break;
  }
  return std::chrono::nanoseconds(0);
}

}  // namespace alidade
