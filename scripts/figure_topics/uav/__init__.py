# SPDX-License-Identifier: Apache-2.0
"""uav: small flying objects seen by receivers that look at different times."""

from figure_topics.uav import recording, tables

SECTIONS = [*tables.SECTIONS, *recording.SECTIONS]
