// SPDX-License-Identifier: Apache-2.0
#include "app/progress_display.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ostream>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

namespace alidade {
namespace {

constexpr auto kBarInterval = std::chrono::milliseconds(100);   // faster than this nobody reads
constexpr auto kLineInterval = std::chrono::seconds(10);        // a log of an hour stays below 400 lines
constexpr auto kJsonInterval = std::chrono::milliseconds(200);  // enough for a bar drawn by another program
constexpr int kBarCells = 24;

std::string format_duration(double seconds) {
  const auto whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

std::string count(const Progress& progress) {
  return progress.total > 0 ? fmt::format("{}/{}", progress.done, progress.total) : fmt::format("{}", progress.done);
}

}  // namespace

ProgressDisplay::ProgressDisplay(DisplayStyle style, std::ostream& out, std::ostream& err, int columns)
    : style_(style), out_(out), err_(err), columns_(columns) {}

ProgressDisplay::~ProgressDisplay() {
  erase_bar();
}

// A new stage, a message and the end of a stage are always worth showing.
bool ProgressDisplay::is_due(const Progress& progress, Clock::duration interval, Clock::time_point now) {
  const bool new_stage = progress.stage != stage_;
  if (new_stage) {
    stage_ = progress.stage;
    stage_start_ = now;
    stage_first_ = progress.done;
  }
  const bool ended = progress.total > 0 && progress.done >= progress.total;
  if (!new_stage && !ended && progress.message.empty() && now - shown_ < interval) return false;
  shown_ = now;
  return true;
}

std::string ProgressDisplay::remaining(const Progress& progress, Clock::time_point now) const {
  const auto done = progress.done - stage_first_;
  const double elapsed_s = std::chrono::duration<double>(now - stage_start_).count();
  if (done <= 0 || elapsed_s < 1.0 || progress.total <= progress.done) return "";
  const double left_s = elapsed_s * static_cast<double>(progress.total - progress.done) / static_cast<double>(done);
  return fmt::format(", {} left", format_duration(left_s));
}

void ProgressDisplay::erase_bar() {
  if (bar_drawn_) err_ << "\r\x1b[K" << std::flush;
  bar_drawn_ = false;
}

void ProgressDisplay::draw_bar(const Progress& progress, Clock::time_point now) {
  if (!is_due(progress, kBarInterval, now)) return;
  erase_bar();
  if (!progress.message.empty()) err_ << progress.message << '\n';
  std::string line = progress.stage;
  if (progress.total > 0) {
    const auto filled =
        static_cast<int>(std::clamp<std::int64_t>(progress.done * kBarCells / progress.total, 0, kBarCells));
    line += fmt::format(" [{:=<{}}{: <{}}]", "", filled, "", kBarCells - filled);
  }
  line += fmt::format(" {}{}", count(progress), remaining(progress, now));
  // A line wider than the terminal would wrap and could not be redrawn.
  err_ << line.substr(0, static_cast<std::size_t>(std::max(columns_ - 1, 1))) << std::flush;
  bar_drawn_ = true;
}

void ProgressDisplay::write_line(const Progress& progress, Clock::time_point now) {
  if (!is_due(progress, kLineInterval, now)) return;
  const std::string message = progress.message.empty() ? "" : ": " + progress.message;
  err_ << progress.stage << ' ' << count(progress) << remaining(progress, now) << message << std::endl;
}

void ProgressDisplay::write_json(const nlohmann::json& event) {
  // Text from file names may not be UTF-8; a replacement character is better than no line.
  out_ << event.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
}

void ProgressDisplay::show(const Progress& progress, Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  if (style_ == DisplayStyle::Bar) draw_bar(progress, now);
  if (style_ == DisplayStyle::Lines) write_line(progress, now);
  if (style_ == DisplayStyle::Json && is_due(progress, kJsonInterval, now))
    write_json({{"event", "progress"},
                {"stage", progress.stage},
                {"done", progress.done},
                {"total", progress.total},
                {"message", progress.message}});
}

void ProgressDisplay::tell(const std::string& line) {
  const std::scoped_lock lock(mutex_);
  if (style_ == DisplayStyle::Quiet) return;
  if (style_ == DisplayStyle::Json) return write_json({{"event", "message"}, {"text", line}});
  erase_bar();
  out_ << line << std::endl;
}

void ProgressDisplay::warn(const std::string& line) {
  const std::scoped_lock lock(mutex_);
  if (style_ == DisplayStyle::Json) write_json({{"event", "warning"}, {"text", line}});
  erase_bar();
  err_ << "warning: " << line << std::endl;
}

void ProgressDisplay::publish(const nlohmann::json& result) {
  const std::scoped_lock lock(mutex_);
  if (style_ != DisplayStyle::Json) return;
  nlohmann::json event = result;
  event["event"] = "result";
  write_json(event);
}

void ProgressDisplay::stream(const nlohmann::json& event) {
  const std::scoped_lock lock(mutex_);
  erase_bar();
  write_json(event);
}

DisplayStyle choose_style(bool quiet, bool json) {
  if (quiet) return DisplayStyle::Quiet;
  if (json) return DisplayStyle::Json;
  const char* terminal = std::getenv("TERM");
  const bool redraws = isatty(STDERR_FILENO) == 1 && terminal && std::string_view(terminal) != "dumb";
  return redraws ? DisplayStyle::Bar : DisplayStyle::Lines;
}

int terminal_columns() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

}  // namespace alidade
