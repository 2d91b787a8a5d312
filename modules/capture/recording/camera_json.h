// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "capture/camera_device.h"

namespace alidade {

/// What session.json says of a camera; what is read is what was written. Reading throws nlohmann::json::exception.
nlohmann::json to_json(const CameraFacts& facts);
CameraFacts camera_facts_of(const nlohmann::json& j);
nlohmann::json to_json(const CameraRequest& request);
CameraRequest camera_request_of(const nlohmann::json& j);

}  // namespace alidade
