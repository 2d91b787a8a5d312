// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "app/experiments/cpu_clock.h"
#include "app/experiments/recorded_flight.h"
#include "app/experiments/targets_experiment.h"
#include "calib/receivers/receiver_checks.h"
#include "calib/receivers/spline_bundle.h"
#include "datasets/flight_faults.h"

namespace alidade {
namespace {

constexpr double kFrameWithin_s = 0.1;
constexpr std::array<double, 3> kDelays_s{0.0, 0.25, 0.5};
constexpr double kLost_s = 0.2, kLostEvery_s = 60.0;  // six frames of 30 Hz a minute
constexpr double kFocalFactor = 1.03;
constexpr unsigned kDisturbedStarts = 3;

std::string metres(std::optional<double> value) {
  return value ? fmt::format("{:.3f}", *value) : "-";
}

nlohmann::json json_of(const JudgedAnswers& judged) {
  nlohmann::json json{
      {"share", judged.share}, {"rmse_m", judged.all.rmse_m}, {"rmse_without_jumps_m", judged.without_jumps.rmse_m}};
  if (judged.all.aligned_rmse_m) json["aligned_rmse_m"] = *judged.all.aligned_rmse_m;
  if (judged.without_jumps.aligned_rmse_m) json["aligned_rmse_without_jumps_m"] = *judged.without_jumps.aligned_rmse_m;
  if (judged.all.error_per_sigma) {
    json["error_per_sigma_to_theory"] = *judged.all.error_per_sigma / kTheoreticalErrorPerSigma;
  }
  return json;
}

// A table's row and the summary's entry of some answers.
void add(const std::string& what, const std::string& key, const JudgedAnswers& judged, ReportTable& table,
         nlohmann::json& summary) {
  const auto& sigma = judged.all.error_per_sigma;
  table.rows.push_back({what, fmt::format("{:.1f} %", 100.0 * judged.share), metres(judged.all.rmse_m),
                        metres(judged.all.aligned_rmse_m), metres(judged.without_jumps.rmse_m),
                        metres(judged.without_jumps.aligned_rmse_m),
                        sigma ? fmt::format("{:.2f}", *sigma / kTheoreticalErrorPerSigma) : "-"});
  summary[key] = json_of(judged);
}

ReportTable score_table(const std::string& title) {
  return {title,
          {"answered by", "epochs", "RMSE (m)", "aligned (m)", "without jumps (m)", "aligned (m)", "error/sigma"},
          {}};
}

Series series_of(const std::string& name, const FlightAnswers& answers, const JudgedFlight& flight) {
  Series series{name, {}, {}, SeriesStyle::Dots, {}};
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!answers[i]) continue;
    series.x.push_back(to_seconds(flight.epochs[i].time - Timestamp{}));
    series.y.push_back((answers[i]->estimate - answers[i]->truth).norm());
  }
  return series;
}

Plot clock_plot(const FlightPath& path, const std::vector<Receiver>& receivers) {
  Plot plot{"Clocks re-estimated in operation, against those of the first half", "time (s)", "to be added (ms)", {}};
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    Series series{receivers[k].name, {}, {}, SeriesStyle::Line, {}};
    for (const FlightStep& step : path.steps) {
      series.x.push_back(to_seconds(step.state.time - Timestamp{}));
      series.y.push_back(1e3 * step.receivers[k].clock_s);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

FlightPath path_of(const std::vector<Receiver>& receivers, const std::vector<Bearing>& bearings) {
  return estimate_flight(receivers, bearings).value_or(FlightPath{});
}

// Accuracy with poses and clocks of the first half.
void add_accuracy(const JudgedFlight& flight, ExperimentSection& section) {
  const std::vector<Bearing> bearings = bearings_of(flight.given, flight.readings);
  const FlightAnswers still = static_answers(bearings, flight);
  const FlightAnswers sure = answers_of(path_of(with_sure_clocks(flight.given), bearings), flight);
  const double begin_s = thread_seconds();
  const FlightPath path = path_of(flight.given, bearings);
  section.summary["path_cpu_s"] = thread_seconds() - begin_s;
  const FlightAnswers ours = answers_of(path, flight);
  const std::vector<Bearing> refocused = bearings_of(flight.found, flight.readings);
  const FlightAnswers found = answers_of(path_of(flight.found, refocused), flight);
  ReportTable table = score_table("Second half, three receivers or more; poses and clocks are of the first half");
  add("static triangulation", "static", judge(still, flight), table, section.summary);
  add("path, clocks as given", "clocks_given", judge(sure, flight), table, section.summary);
  add("path, clocks in operation", "path", judge(ours, flight), table, section.summary);
  add("... at the static ones' epochs", "path_where_static", judge(where_both(ours, still), flight), table,
      section.summary);
  add("static, focal lengths found", "static_focal", judge(static_answers(refocused, flight), flight), table,
      section.summary);
  add("path, focal lengths found", "path_focal", judge(found, flight), table, section.summary);
  section.tables.push_back(std::move(table));
  section.figures.push_back({"recording_errors.png",
                             "Distance from the truth at each epoch.",
                             {{"Second half of the flight",
                               "time (s)",
                               "error (m)",
                               {series_of("static triangulation", still, flight), series_of("path", ours, flight),
                                series_of("path, focal lengths found", found, flight)}},
                              clock_plot(path, flight.given)}});
}

// One frame per receiver and epoch; `ignored`: taken for the epoch's moment.
std::vector<Bearing> frames_at(const JudgedFlight& flight, std::span<const double> delays_s, bool ignored) {
  std::vector<Timestamp> epochs;
  for (const TimedPosition& epoch : flight.epochs) epochs.push_back(epoch.time);
  std::vector<Bearing> bearings;
  for (const EpochReading& chosen : epoch_readings(flight.given, flight.readings, epochs, delays_s, kFrameWithin_s)) {
    const Receiver* receiver = &flight.given.front();
    for (const Receiver& r : flight.given) receiver = r.id == chosen.reading.receiver ? &r : receiver;
    auto bearing = bearing_of(*receiver, chosen.reading);
    if (!bearing) continue;
    if (ignored) bearing->time = epochs[chosen.epoch];
    bearings.push_back(*bearing);
  }
  std::stable_sort(bearings.begin(), bearings.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return bearings;
}

double answered_of(const FlightAnswers& answers, const FlightAnswers& of) {
  int both = 0, wanted = 0;
  for (std::size_t i = 0; i < of.size(); ++i) {
    wanted += of[i].has_value();
    both += of[i] && answers[i];
  }
  return wanted > 0 ? static_cast<double>(both) / wanted : 0.0;
}

void add_delays(const JudgedFlight& flight, ExperimentSection& section) {
  constexpr std::array<double, 1> kNone{0.0};
  const auto undelayed = frames_at(flight, kNone, true), ignored = frames_at(flight, kDelays_s, true);
  const auto stamped_undelayed = frames_at(flight, kNone, false), stamped = frames_at(flight, kDelays_s, false);
  const FlightAnswers still = static_answers(undelayed, flight), still_ignored = static_answers(ignored, flight);
  const FlightAnswers ours = answers_of(path_of(flight.given, stamped_undelayed), flight);
  const FlightAnswers ours_ignored = answers_of(path_of(flight.given, ignored), flight);
  const FlightAnswers ours_stamped = answers_of(path_of(flight.given, stamped), flight);
  ReportTable table = score_table("One frame per receiver and epoch, receiver k's taken (k mod 3) 0.25 s late");
  nlohmann::json& summary = section.summary["delays"];
  const auto take = [&](const std::string& what, const std::string& key, const FlightAnswers& answers) {
    const JudgedAnswers judged = judge(answers, flight);
    add(what, key, judged, table, summary);
    return judged.all.rmse_m;
  };
  const double still_m = take("static, none late", "static", still);
  const double still_ignored_m = take("static, delays ignored", "static_ignored", still_ignored);
  const double ours_m = take("path, none late", "path", ours);
  const double ours_ignored_m = take("path, delays ignored", "path_ignored", ours_ignored);
  take("path, stamped", "path_stamped", ours_stamped);
  const FlightAnswers both = where_both(ours_stamped, ours);
  const double ours_stamped_m = take("... where none late answers", "path_stamped_there", both);
  summary["static_ignored_to_undelayed"] = still_ignored_m / still_m;
  summary["path_ignored_to_undelayed"] = ours_ignored_m / ours_m;
  summary["path_stamped_to_undelayed"] = ours_stamped_m / ours_m;
  summary["path_stamped_answered"] = answered_of(ours_stamped, ours);
  section.tables.push_back(std::move(table));
}

// The receiver whose clock is known best gives the common time.
int time_receiver_of(const JudgedFlight& flight) {
  const auto best = std::min_element(flight.given.begin(), flight.given.end(), [](const auto& a, const auto& b) {
    return a.clock.covariance(0, 0) < b.clock.covariance(0, 0);
  });
  return best->id;
}

void add_bundle(const JudgedFlight& flight, ExperimentSection& section) {
  SplineBundleOptions options;
  options.time_receiver = time_receiver_of(flight);
  const FlightAnswers seen = answers_of(path_of(flight.given, bearings_of(flight.given, flight.readings)), flight);
  ReportTable table = score_table("Spline bundle of the second half, without truth");
  nlohmann::json& summary = section.summary["bundle"];
  const auto bundled = [&](const std::string& what, const std::string& key, const std::vector<Receiver>& start) {
    const double begin_s = thread_seconds();
    const auto bundle = bundle_flight(start, flight.readings, options);
    const double cpu_s = thread_seconds() - begin_s;
    FlightAnswers answers(flight.epochs.size());
    for (std::size_t i = 0; bundle && i < answers.size(); ++i) {
      const auto point = bundle->path.at(to_seconds(flight.epochs[i].time - Timestamp{}));
      if (seen[i] && point) answers[i] = PositionPair{point->p_world, flight.epochs[i].p, Eigen::Matrix3d::Zero()};
    }
    const JudgedAnswers judged = judge(answers, flight);
    add(what, key, judged, table, summary);
    summary[key]["cpu_s"] = cpu_s;
    return judged.all.aligned_rmse_m.value_or(std::nan(""));
  };
  const double undisturbed_m = bundled("from the given receivers", "undisturbed", flight.given);
  double worst = 0.0;
  for (unsigned seed = 1; seed <= kDisturbedStarts; ++seed) {
    const auto start = disturbed(flight.given, {.time_receiver = *options.time_receiver, .seed = seed});
    const double aligned_m =
        bundled(fmt::format("from 1 m, 0.01 rad, 0.1 s off, seed {}", seed), fmt::format("disturbed_{}", seed), start);
    worst = std::max(worst, aligned_m / undisturbed_m);
  }
  summary["disturbed_to_undisturbed"] = worst;
  section.tables.push_back(std::move(table));
}

// Counts the faults of a kind that are named, and what is named besides.
struct NamedFaults {
  int put_in = 0, named = 0, besides = 0;

  void count(const std::vector<ReceiverFinding>& found, const std::vector<ReceiverFinding>& untouched,
             const ReceiverFinding& wanted) {
    ++put_in;
    for (const ReceiverFinding& f : found) {
      if (f.fault == wanted.fault && f.receiver == wanted.receiver && f.other == wanted.other) {
        ++named;
        continue;
      }
      const bool was_there = std::any_of(untouched.begin(), untouched.end(),
                                         [&](const auto& u) { return u.fault == f.fault && u.receiver == f.receiver; });
      besides += !was_there;
    }
  }
};

void add_checks(const FlightRecording& recording, const JudgedFlight& flight, ExperimentSection& section) {
  const KnownTrack track(flight.first_half);
  const auto& receivers = recording.receivers;
  const auto check = [&](const auto& some, const auto& readings) { return check_receivers(some, readings, track); };
  const auto untouched = check(receivers, recording.readings);
  NamedFaults places, focal, clocks;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const int id = receivers[i].id;
    for (std::size_t j = i + 1; j < receivers.size(); ++j) {
      places.count(check(with_swapped_places(receivers, i, j), recording.readings), untouched,
                   {ReceiverFault::SwappedPlaces, id, receivers[j].id});
    }
    focal.count(check(with_focal_scaled(receivers, i, kFocalFactor), recording.readings), untouched,
                {ReceiverFault::WrongFocal, id});
    // A clock that is uneven already proves nothing.
    const bool is_uneven = std::any_of(untouched.begin(), untouched.end(), [&](const auto& f) {
      return f.fault == ReceiverFault::UnevenClock && f.receiver == id;
    });
    if (is_uneven) continue;
    clocks.count(check(receivers, with_dropped_frames(recording.readings, id, kLost_s, kLostEvery_s)), untouched,
                 {ReceiverFault::UnevenClock, id});
  }
  ReportTable table{"Faults put into the first half", {"fault", "put in", "named", "named besides"}, {}};
  const auto row = [&](const std::string& what, const std::string& key, const NamedFaults& n) {
    table.rows.push_back({what, std::to_string(n.put_in), std::to_string(n.named), std::to_string(n.besides)});
    section.summary["checks"][key] = {{"put_in", n.put_in}, {"named", n.named}, {"besides", n.besides}};
  };
  row("two receivers' places swapped", "places", places);
  row("focal lengths x 1.03", "focal", focal);
  row("0.2 s of frames dropped a minute", "clocks", clocks);
  section.tables.push_back(std::move(table));
  section.summary["checks"]["untouched"] = nlohmann::json::array();
  for (const ReceiverFinding& f : untouched) {
    section.summary["checks"]["untouched"].push_back(describe(f));
    section.remarks.push_back("In the recording as it is: " + describe(f) + ".");
  }
}

}  // namespace

ExperimentSection targets_recording(const std::filesystem::path& recording, const ExperimentContext& context) {
  const FlightRecording flight = read_flight(recording);
  ExperimentSection section{"recording", "A real flight: the half of it on which nothing was fitted", {}, {}, {}, {}};
  const JudgedFlight judged = judged_flight(flight, recording);
  const auto jumps = std::count(judged.is_jump.begin(), judged.is_jump.end(), true);
  section.remarks.push_back(
      fmt::format("{} of {} epochs of the truth jump aside and back by what no flight does: scored with and without "
                  "them. error/sigma: median error over stated standard deviation, 1 for normal errors.",
                  jumps, judged.epochs.size()));
  section.summary["jumps"] = jumps;
  std::string scales;
  for (std::size_t k = 0; k < judged.given.size(); ++k) {
    scales += fmt::format("{}{} x {:.3f}", k > 0 ? ", " : "", judged.given[k].name, judged.focal_scales[k]);
    section.summary["focal_scales"].push_back(judged.focal_scales[k]);
  }
  section.remarks.push_back("Focal lengths found with pose and clock on the first half, of those published: " + scales +
                            ".");
  add_accuracy(judged, section);
  if (!context.stop.stop_requested()) add_delays(judged, section);
  if (!context.stop.stop_requested()) add_bundle(judged, section);
  if (!context.stop.stop_requested()) add_checks(flight, judged, section);
  return section;
}

}  // namespace alidade
