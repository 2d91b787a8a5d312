// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "app/evaluation_results.h"
#include "view/report.h"

namespace alidade {

/// The centres of truth and aligned estimate, seen along the axis in which the truth extends least (a top view for a
/// path over ground); BGR.
cv::Mat draw_paths(const EvaluationRecord& record);

/// Position and rotation error over time, and NEES where there is one, below each other; BGR.
cv::Mat draw_errors(const EvaluationRecord& record);

/// The page for a reader: figures of the table, both pictures, links to the files beside it.
Report report_of(const EvaluationRecord& record, const std::vector<std::string>& arguments, const std::string& options);

}  // namespace alidade
