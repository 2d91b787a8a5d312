// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/heartbeat.h"

#include <arv.h>

namespace alidade {

void await_heartbeat(ArvCamera* camera, void* listener) {
  GObject* const device = G_OBJECT(arv_camera_get_device(camera));
  g_signal_handlers_disconnect_matched(device, G_SIGNAL_MATCH_DATA, 0, 0, nullptr, nullptr, listener);
  constexpr int kTries = 1000;
  for (int i = 0; g_atomic_int_get(&device->ref_count) > 1 && i < kTries; ++i) g_usleep(1000);
}

}  // namespace alidade
