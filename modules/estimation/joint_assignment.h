// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace alidade {

/// How probable it is, over all ways to give detections to tracks at most one to one, that a track has a detection.
/// `likelihood` (tracks × detections): of the detection being the track's, relative to its being a stray one; 0:
/// impossible.
/// `miss` (tracks, > 0): of the track's having none. Returns tracks × (detections + 1), rows of sum 1; the
/// last column is "none". Rows of zeros where tracks and detections are so entangled that the ways are too many (more
/// than 10⁵).
/// Source: Bar-Shalom, Daum, Huang, The probabilistic data association filter, 2009 (joint events, eq. 47).
Eigen::MatrixXd joint_assignment(const Eigen::MatrixXd& likelihood, const Eigen::VectorXd& miss);

}  // namespace alidade
