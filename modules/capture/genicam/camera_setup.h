// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "capture/camera_device.h"
#include "capture/genicam/aravis_objects.h"
#include "capture/genicam/pfnc_format.h"

namespace alidade {

/// What a camera granted, and how its images come.
struct CameraSetup {
  CameraFacts facts;
  PfncFormat wire;
};

/// Makes the camera what `request` wants (packet size and its stream apart) and reads back what it granted. Throws
/// CameraError: a feature that it has not or refuses, a pixel format that we cannot read.
CameraSetup set_up_camera(ArvCamera* camera, const CameraRequest& request, const std::string& source);

}  // namespace alidade
