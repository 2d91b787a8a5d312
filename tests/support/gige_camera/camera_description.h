// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <opencv2/core/types.hpp>

namespace alidade::test {

/// Numbers of the choices that the description offers.
constexpr std::uint32_t kAutoOff = 0;
constexpr std::uint32_t kAutoContinuous = 2;
constexpr std::uint32_t kTriggerSourceLine0 = 0;
constexpr std::uint32_t kTriggerSourceSoftware = 1;
constexpr std::uint32_t kSingleFrame = 1;

/// What the camera tells of its features and where they lie: a GenICam description, named by SFNC. `sensor` in px.
std::string camera_description(cv::Size sensor);

}  // namespace alidade::test
