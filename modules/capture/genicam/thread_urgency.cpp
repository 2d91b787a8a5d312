// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/thread_urgency.h"

#include <sys/resource.h>
#include <unistd.h>

namespace alidade {

void make_this_thread_urgent() {
  // Linux takes the number of a thread for that of a process here.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), -10);
}

}  // namespace alidade
