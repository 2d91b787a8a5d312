// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/faults/genicam/fault_bench.h"

namespace alidade::test {

/// ms from the last frame until Aravis, used as its manual has it, tells that a killed camera is gone ("control-lost").
/// 0 where it gave no frame, or did not tell within 20 s.
double aravis_notice_ms(const FaultBench& bench);

}  // namespace alidade::test
