# SPDX-License-Identifier: Apache-2.0
"""uav: small flying objects seen by receivers that look at different times."""

SECTIONS = []
