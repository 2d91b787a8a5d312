// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace alidade {

enum class Verdict { None, Good, Poor };

/// One line of a table of results.
struct ReportRow {
  std::string name;   ///< "absolute trajectory error (RMSE, Sim(3))"
  std::string value;  ///< as printed: "3.21"
  std::string unit;   ///< "cm", or empty
  Verdict verdict = Verdict::None;
  std::string remark{};  ///< one sentence beside it, or empty
};

enum class FigureFormat { Png, Jpeg };  ///< plots and drawings; photographs

/// A picture embedded in the report.
struct ReportFigure {
  cv::Mat image;  ///< CV_8UC1 or CV_8UC3 (BGR)
  std::string caption;
  FigureFormat format = FigureFormat::Png;
};

/// A table of many columns; cells are printed as they stand, the first column names the row.
struct ReportTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// A file that lies beside the report and that it links to.
struct ReportLink {
  std::string file;  ///< path relative to the report
  std::string what;
};

/// Rows of lines "name: value"; a line without a colon is a name alone.
std::vector<ReportRow> rows_of(std::span<const std::string> lines);

struct ReportSection {
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<ReportRow> rows;
  std::vector<ReportFigure> figures;
  std::vector<ReportTable> tables{};
};

/// What a run leaves for its reader: one page without scripts or anything fetched, to open in a browser or to mail.
struct Report {
  std::string title;
  std::vector<std::string> arguments;  ///< the command line
  std::vector<ReportRow> summary;
  std::vector<std::string> warnings;
  std::vector<ReportSection> sections;
  std::vector<ReportLink> links;
  std::string options;  ///< the effective options, as YAML text
};

/// The page as HTML. All text is taken literally (escaped). Throws std::invalid_argument for an image of another type.
std::string render_html(const Report& report);

/// Writes the page atomically: to `path`.part, then renamed. Throws DeviceError where the file cannot be written.
void write_report(const std::filesystem::path& path, const Report& report);

}  // namespace alidade
