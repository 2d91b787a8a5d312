// SPDX-License-Identifier: Apache-2.0
#pragma once

using ArvCamera = struct _ArvCamera;

namespace alidade {

/// Before a camera is let go: disconnects the handlers of its device that were connected with `listener` as their data,
/// and waits, 1 s at most, until Aravis' heartbeat thread is through with telling of a loss. That thread holds the
/// device meanwhile; were it the last to let go, it would wait for its own end, and GLib end the program.
void await_heartbeat(ArvCamera* camera, void* listener);

}  // namespace alidade
