# SPDX-License-Identifier: Apache-2.0
"""uav: small flying objects seen by receivers that look at different times."""

from figure_topics.uav import bad_input, batch, cue, recording, tables, tracker, video, window

SECTIONS = [*tables.SECTIONS, *batch.SECTIONS, *window.SECTIONS, *tracker.SECTIONS, *cue.SECTIONS,
            *recording.SECTIONS, *video.SECTIONS, *bad_input.SECTIONS]
