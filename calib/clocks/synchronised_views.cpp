// SPDX-License-Identifier: Apache-2.0
#include "calib/clocks/synchronised_views.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "calib/clocks/board_film.h"

namespace alidade {
namespace {

struct ChosenMoment {
  std::size_t camera = 0;
  std::size_t view = 0;
};

// By the rig's time.
using ChosenMoments = std::map<double, ChosenMoment>;

// Whether no moment lies closer than what four frames of the slowest camera span, so that each has views of its own.
bool is_apart(const ChosenMoments& moments, double time_s, double least_s) {
  const auto after = moments.lower_bound(time_s);
  if (after != moments.end() && after->first - time_s < least_s) return false;
  return after == moments.begin() || time_s - std::prev(after)->first >= least_s;
}

ChosenMoments choose_moments(std::span<const RigCameraViews> films, std::span<const double> offsets_s, double least_s,
                             const ViewSelectionOptions& options) {
  ChosenMoments moments;
  for (std::size_t c = 0; c < films.size(); ++c) {
    for (const int i : select_views(films[c].views, films[c].image, options)) {
      const auto view = static_cast<std::size_t>(i);
      const double time_s = films[c].views[view].time_s + offsets_s[c];
      if (is_apart(moments, time_s, least_s)) moments.emplace(time_s, ChosenMoment{c, view});
    }
  }
  return moments;
}

}  // namespace

std::vector<RigCameraViews> synchronise(std::span<const RigCameraViews> films, std::span<const double> offsets_s,
                                        const ViewSelectionOptions& options) {
  if (films.size() != offsets_s.size()) throw std::invalid_argument("an offset per camera is wanted");
  std::vector<BoardFilm> interpolated;
  std::vector<RigCameraViews> cameras;
  double interval_s = 0;
  for (const RigCameraViews& film : films) {
    interpolated.emplace_back(film.views);
    interval_s = std::max(interval_s, interpolated.back().interval_s());
    cameras.push_back({film.name, film.image, {}});
  }
  int moment = 0;
  for (const auto& [time_s, chosen] : choose_moments(films, offsets_s, 4.0 * interval_s, options)) {
    for (std::size_t c = 0; c < films.size(); ++c) {
      std::optional<BoardView> view;
      if (c == chosen.camera) {
        view = films[c].views[chosen.view];
      } else if (auto between = interpolated[c].at(time_s - offsets_s[c])) {
        view = std::move(between->view);
      }
      if (!view) continue;
      view->frame = moment;
      view->time_s = time_s;
      cameras[c].views.push_back(std::move(*view));
    }
    ++moment;
  }
  return cameras;
}

}  // namespace alidade
