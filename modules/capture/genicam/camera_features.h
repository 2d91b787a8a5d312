// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "capture/camera_listing.h"
#include "capture/genicam/aravis_objects.h"

namespace alidade {

/// The names of all features that the camera describes, in its own order, each once.
std::vector<std::string> feature_names(ArvDevice* device);

/// Whether the camera has that feature, and has it now.
bool has_feature(ArvDevice* device, const std::string& name);

/// The strings that an enumeration takes now; empty where there is no enumeration of that name.
std::vector<std::string> enumeration_choices(ArvDevice* device, const std::string& name);

/// The feature as it is now.
ListedControl describe_feature(ArvDevice* device, const std::string& name);

/// Sets a feature from text; a command is executed (value empty or "1"). Throws CameraError (`source` names the
/// camera): no such feature, with the nearest name; not writable; not a value of it, with those that it takes.
void set_feature(ArvDevice* device, const std::string& name, const std::string& value, const std::string& source);

}  // namespace alidade
