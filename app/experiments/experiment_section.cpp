// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/experiment_section.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace alidade {
namespace {

std::string padded(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += i == 0 ? fmt::format("{:<{}}", cells[i], widths[i]) : fmt::format("  {:>{}}", cells[i], widths[i]);
  }
  return line;
}

}  // namespace

std::vector<std::string> lines_of(const ReportTable& table) {
  std::vector<std::size_t> widths(table.columns.size(), 0);
  for (std::size_t i = 0; i < widths.size(); ++i) {
    widths[i] = table.columns[i].size();
    for (const auto& row : table.rows) widths[i] = std::max(widths[i], row[i].size());
  }
  std::vector<std::string> lines{table.title, padded(table.columns, widths)};
  for (const auto& row : table.rows) lines.push_back(padded(row, widths));
  return lines;
}

std::string csv_of(const ReportTable& table) {
  const auto quoted = [](const std::vector<std::string>& cells) {
    std::vector<std::string> result;
    for (const std::string& cell : cells) {
      result.push_back(cell.find(',') == std::string::npos ? cell : fmt::format("\"{}\"", cell));
    }
    return fmt::format("{}\n", fmt::join(result, ","));
  };
  std::string text = quoted(table.columns);
  for (const auto& row : table.rows) text += quoted(row);
  return text;
}

}  // namespace alidade
