// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/options_yaml.h"
#include "tracking/camera_tracker_options.h"

namespace alidade {

/// Binds the tracker's options to flags and keys of --config. `options` must outlive `fields`.
void bind(OptionFields& fields, CameraTrackerOptions& options);

}  // namespace alidade
