// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/progress.h"
#include "view/plot.h"
#include "view/report.h"
#include "view/scene.h"

namespace alidade {

/// Plots that share a picture.
struct ExperimentFigure {
  std::string file;  ///< "accuracy_smooth.png"
  std::string caption;
  std::vector<Plot> plots;
};

/// A picture of cameras and what they see.
struct ExperimentScene {
  std::string file;  ///< "stills_ours.png"
  std::string caption;
  TrackPicture picture;
};

/// One part of an experiment: what it shows, in words, tables, pictures and numbers.
struct ExperimentSection {
  std::string name;   ///< "accuracy": the word of --only, and the key in summary.json
  std::string title;  ///< for a reader
  std::vector<std::string> remarks;
  std::vector<ReportTable> tables;
  std::vector<ExperimentFigure> figures;
  nlohmann::json summary;
  std::vector<ExperimentScene> scenes{};
};

/// What a part is given.
struct ExperimentContext {
  int runs = 100;
  unsigned seed = 1;
  ProgressSink progress;
  std::stop_token stop;
};

/// The lines of a table for a terminal, columns aligned.
std::vector<std::string> lines_of(const ReportTable& table);

/// The table as CSV.
std::string csv_of(const ReportTable& table);

}  // namespace alidade
