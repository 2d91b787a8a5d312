// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <iosfwd>
#include <mutex>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/progress.h"

namespace alidade {

/// How the user is told: a bar that is redrawn, lines every few seconds (a log), JSON lines, or nothing but warnings.
enum class DisplayStyle { Bar, Lines, Json, Quiet };

/// The one place that writes to stdout and stderr while a verb runs; callable from any thread.
/// Bar, lines and warnings go to stderr, results and JSON to stdout. JSON lines have "event": "progress" (stage, done,
/// total, message), "message" (text), "warning" (text) or "result" (the verb's summary); a live feed has its own.
class ProgressDisplay {
 public:
  using Clock = std::chrono::steady_clock;

  /// The streams must outlive the display; `columns` is the width of the terminal.
  ProgressDisplay(DisplayStyle style, std::ostream& out, std::ostream& err, int columns = 80);
  ~ProgressDisplay();  ///< leaves the terminal on a fresh line

  void show(const Progress& progress, Clock::time_point now = Clock::now());
  void tell(const std::string& line);
  void warn(const std::string& line);
  void publish(const nlohmann::json& result);
  void stream(const nlohmann::json& event);  ///< a live feed: in every style, Quiet too

 private:
  void draw_bar(const Progress& progress, Clock::time_point now);
  void write_line(const Progress& progress, Clock::time_point now);
  void write_json(const nlohmann::json& event);
  void erase_bar();
  bool is_due(const Progress& progress, Clock::duration interval, Clock::time_point now);
  std::string remaining(const Progress& progress, Clock::time_point now) const;

  DisplayStyle style_;
  std::ostream& out_;
  std::ostream& err_;
  int columns_;
  std::mutex mutex_;
  bool bar_drawn_ = false;
  std::string stage_;
  Clock::time_point stage_start_;
  std::int64_t stage_first_ = 0;  // units done when the stage was first seen
  Clock::time_point shown_;
};

/// The style for these flags and this machine: a bar only where stderr is a terminal that can redraw a line.
DisplayStyle choose_style(bool quiet, bool json);

/// Columns of the terminal on stderr, 80 where it has none.
int terminal_columns();

}  // namespace alidade
