// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace alidade {

/// Lets this thread run before others of a busy machine (nice level -10), where the user may; else all stays as it is.
void make_this_thread_urgent();

}  // namespace alidade
