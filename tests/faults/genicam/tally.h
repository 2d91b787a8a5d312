// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tests/faults/genicam/live_capture.h"
#include "tests/support/gige_camera/camera_log.h"

namespace alidade::test {

/// What became of the frames that a camera exposed between the first and the last good one that came.
struct Tally {
  int exposed = 0;     ///< by the camera's log
  int never_sent = 0;  ///< of these, by the camera's log
  int good = 0;        ///< came, and as good
  int wrong = 0;       ///< of these: of other pixels than were exposed
  int damaged = 0;     ///< came, and said so
  int nameless = 0;    ///< of these: without their number
  int counted = 0;     ///< dropped, as we counted them
  int unexplained() const { return exposed - good - (damaged - nameless) - counted; }  ///< neither good nor told of
};

/// `frames` of one acquisition of the camera that wrote `log`, and nothing but the test pattern.
Tally tally_of(const std::vector<SeenFrame>& frames, const std::vector<LoggedFrame>& log);

/// The frame of the log that was stamped so; null where there is none.
const LoggedFrame* find_stamped(const std::vector<LoggedFrame>& log, const CaptureStamp& stamp);

}  // namespace alidade::test
