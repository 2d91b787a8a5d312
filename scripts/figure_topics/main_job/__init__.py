# SPDX-License-Identifier: Apache-2.0
"""main-job: track a camera through images, from a bare machine to a compared result."""

from figure_topics.main_job import bad_input, machine, recordings, rendered

SECTIONS = [*recordings.SECTIONS, *rendered.SECTIONS, *bad_input.SECTIONS, *machine.SECTIONS]
