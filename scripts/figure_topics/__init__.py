# SPDX-License-Identifier: Apache-2.0
"""The topics of scripts/figures, each a list of sections in the order in which they are measured."""

from figure_topics import calibration, camera_tracker, capture, main_job, marker1d, marker1d_recordings, marker1d_use, uav

TOPICS = {"main-job": main_job.SECTIONS, "camera-tracker": camera_tracker.SECTIONS,
          "marker1d": [*marker1d.SECTIONS, *marker1d_recordings.SECTIONS, *marker1d_use.SECTIONS],
          "calibration": calibration.SECTIONS, "capture": capture.SECTIONS, "uav": uav.SECTIONS}
