# SPDX-License-Identifier: Apache-2.0
"""Capture: what cameras, disks and readers do to it, and what is lost by that."""

from figure_topics.capture import bad_input, faults, live, loop, speed

SECTIONS = [*faults.SECTIONS, *speed.SECTIONS, *live.SECTIONS, *loop.SECTIONS, *bad_input.SECTIONS]
