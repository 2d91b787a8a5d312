// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_seeds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "uav/window/window_guess.h"

namespace alidade {
namespace {

constexpr std::size_t kMostScansAsked = 30;   // about a guess: enough to tell
constexpr std::size_t kPicksPerReceiver = 6;  // scans from which guesses start, spread over the window
constexpr std::size_t kMostTriples = 150, kMostPairs = 60, kMostPairsOfTwo = 200;
constexpr double kDelayWorth = 2.0;                 // of the time between pairs, per time within one
constexpr std::size_t kMostPairsTried = 1'000'000;  // a tenth of a second, in the thickest of false bearings
constexpr double kClear = 0.8;                      // of the scans asked have a bearing near a guess: never by chance
constexpr std::size_t kGrownPerAnchor = 3;          // the best guesses through one bearing

struct Seed {
  Support support;
  std::vector<std::size_t> bearings;
};

// A few scans of each receiver, spread over the window; by receiver.
std::vector<std::vector<std::size_t>> pick_scans(const BearingWindow& window) {
  std::vector<int> receivers;
  std::vector<std::vector<std::size_t>> of_receiver;
  for (std::size_t s = 0; s < window.scans.size(); ++s) {
    const auto known = std::find(receivers.begin(), receivers.end(), window.scans[s].receiver);
    const auto k = static_cast<std::size_t>(known - receivers.begin());
    if (known == receivers.end()) {
      receivers.push_back(window.scans[s].receiver);
      of_receiver.emplace_back();
    }
    of_receiver[k].push_back(s);
  }
  for (std::vector<std::size_t>& scans : of_receiver) {
    if (scans.size() <= kPicksPerReceiver) continue;
    std::vector<std::size_t> picked;
    for (std::size_t i = 0; i < kPicksPerReceiver; ++i) {
      picked.push_back(scans[i * (scans.size() - 1) / (kPicksPerReceiver - 1)]);
    }
    scans = std::move(picked);
  }
  return of_receiver;
}

template <std::size_t N>
struct Combination {
  std::array<std::size_t, N> scans{};
  double worth = 0.0;  // s; the greater the better its guesses
};

template <std::size_t N>
std::vector<Combination<N>> best_of(std::vector<Combination<N>> all, std::size_t most) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Combination<N>& a, const Combination<N>& b) { return a.worth > b.worth; });
  if (all.size() > most) all.resize(most);
  return all;
}

// Scans of three receivers at three moments, in order of time.
std::vector<Combination<3>> choose_triples(const BearingWindow& window,
                                           const std::vector<std::vector<std::size_t>>& picks) {
  std::vector<Combination<3>> triples;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    const double before = window.scans[b].t_s - window.scans[a].t_s, after = window.scans[c].t_s - window.scans[b].t_s;
    if (before > 0.0 && after > 0.0) triples.push_back({{a, b, c}, before * after / (before + after)});
  };
  for (std::size_t i = 0; i < picks.size(); ++i) {
    for (std::size_t j = 0; j < picks.size(); ++j) {
      for (std::size_t k = 0; k < picks.size(); ++k) {
        if (i == j || j == k || k == i) continue;
        for (const std::size_t a : picks[i]) {
          for (const std::size_t b : picks[j]) {
            for (const std::size_t c : picks[k]) add(a, b, c);
          }
        }
      }
    }
  }
  return best_of(std::move(triples), kMostTriples);
}

std::size_t nearest_in_time(const BearingWindow& window, const std::vector<std::size_t>& scans, double t_s) {
  return *std::min_element(scans.begin(), scans.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(window.scans[a].t_s - t_s) < std::abs(window.scans[b].t_s - t_s);
  });
}

// Two receivers' scans at about one moment, and the same at a later one. Where there are but two receivers, these are
// all the guesses that there are: of scans farther apart as well.
std::vector<Combination<4>> choose_pairs(const BearingWindow& window,
                                         const std::vector<std::vector<std::size_t>>& picks) {
  std::vector<Combination<4>> pairs;
  const auto t_of = [&](std::size_t s) { return window.scans[s].t_s; };
  const auto beside = [&](const std::vector<std::size_t>& scans, std::size_t s) {
    return picks.size() == 2 ? scans : std::vector<std::size_t>{nearest_in_time(window, scans, t_of(s))};
  };
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    const double delay = std::max(std::abs(t_of(b) - t_of(a)), std::abs(t_of(d) - t_of(c)));
    const double worth = t_of(c) - t_of(a) - kDelayWorth * delay;
    if (b != d && worth > 0.0) pairs.push_back({{a, b, c, d}, worth});
  };
  for (std::size_t i = 0; i < picks.size(); ++i) {
    for (std::size_t j = i + 1; j < picks.size(); ++j) {
      for (const std::size_t a : picks[i]) {
        for (const std::size_t c : picks[i]) {
          for (const std::size_t b : beside(picks[j], a)) {
            for (const std::size_t d : beside(picks[j], c)) add(a, b, c, d);
          }
        }
      }
    }
  }
  return best_of(std::move(pairs), picks.size() == 2 ? kMostPairsOfTwo : kMostPairs);
}

// In a crowd, a wrong guess is near to a bearing of someone once in five scans, and a miss at the beginning sends it
// away: a right one that this loses has others. Among the rest, one is rare: a target that was missed half the time
// shows.
SupportSearch support_in(Crowd crowd, const std::vector<char>& is_free) {
  if (crowd == Crowd::Whole) return {is_free, 0.2, -2.0, 2.0};
  return {is_free, 0.01, -10.0, -3.0};
}

double least_log_ratio_in(const SearchRound& round, const BearingWindow& window) {
  const double gain = std::accumulate(window.log_gain.begin(), window.log_gain.end(), 0.0) /
                      static_cast<double>(window.log_gain.size());
  const double usual = gain * window.options.detection_probability * static_cast<double>(window.scans.size());
  return std::max(window.options.least_log_ratio, round.least_share * usual);
}

class Search {
 public:
  Search(const BearingWindow& window, const SearchRound& round, std::vector<char>& is_free)
      : window_(window),
        is_free_(is_free),
        support_(support_in(round.crowd, is_free)),
        least_log_ratio_(least_log_ratio_in(round, window)) {}

  void try_triple(const std::array<std::size_t, 3>& scans) {
    const auto rest = scans_beside(scans);
    any_free(scans[0], [&](std::size_t a) {
      std::vector<Seed> seeds;
      any_free(scans[1], [&](std::size_t b) {
        return any_free(scans[2], [&](std::size_t c) {
          return consider(guess_of_three(window_, {a, b, c}), {a, b, c}, rest, seeds);
        });
      });
      grow(std::move(seeds));
      return false;
    });
  }

  void try_pairs(const std::array<std::size_t, 4>& scans) {
    const auto rest = scans_beside(scans);
    const auto later = meeting_pairs(scans[2], scans[3]);
    any_free(scans[0], [&](std::size_t a) {
      std::vector<Seed> seeds;
      any_free(scans[1], [&](std::size_t b) {
        if (pairs_tried_ > kMostPairsTried || !may_meet(window_, a, b)) return false;
        pairs_tried_ += later.size();
        return std::any_of(later.begin(), later.end(), [&](const auto& pair) {
          const auto [c, d] = pair;
          return is_free_[c] && is_free_[d] &&
                 consider(guess_of_pairs(window_, {a, b, c, d}), {a, b, c, d}, rest, seeds);
        });
      });
      grow(std::move(seeds));
      return false;
    });
  }

  std::vector<WindowTrack> take_tracks() { return std::move(tracks_); }

 private:
  // Calls function(bearing) for each free bearing of a scan, until it returns true; whether it did.
  template <typename Function>
  bool any_free(std::size_t scan, Function function) {
    const auto& bearings = window_.scans[scan].bearings;
    return std::any_of(bearings.begin(), bearings.end(),
                       [&](std::size_t bearing) { return is_free_[bearing] && function(bearing); });
  }

  std::vector<std::pair<std::size_t, std::size_t>> meeting_pairs(std::size_t one, std::size_t other) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    any_free(one, [&](std::size_t a) {
      return any_free(other, [&](std::size_t b) {
        if (may_meet(window_, a, b)) pairs.emplace_back(a, b);
        return false;
      });
    });
    return pairs;
  }

  // All but these, those between them first: where a guess is surest.
  std::vector<std::size_t> scans_beside(std::span<const std::size_t> taken) {
    const double middle = 0.5 * (window_.scans[taken.front()].t_s + window_.scans[taken.back()].t_s);
    std::vector<std::size_t> rest;
    for (std::size_t s = 0; s < window_.scans.size(); ++s) {
      if (std::find(taken.begin(), taken.end(), s) == taken.end()) rest.push_back(s);
    }
    std::stable_sort(rest.begin(), rest.end(), [&](std::size_t a, std::size_t b) {
      return std::abs(window_.scans[a].t_s - middle) < std::abs(window_.scans[b].t_s - middle);
    });
    if (rest.size() > kMostScansAsked) rest.resize(kMostScansAsked);
    return rest;
  }

  // Whether the guess is so clear that no other through the same bearing needs to be asked.
  bool consider(const std::optional<MotionGuess>& guess, std::initializer_list<std::size_t> bearings,
                std::span<const std::size_t> rest, std::vector<Seed>& seeds) {
    if (!guess) return false;
    auto support = find_support(window_, *guess, rest, support_);
    if (!support) return false;
    seeds.push_back({std::move(*support), bearings});
    return static_cast<double>(seeds.back().support.bearings.size()) >= kClear * static_cast<double>(rest.size());
  }

  // The best track of a seed; its bearings are taken.
  void grow(std::vector<Seed> seeds) {
    std::stable_sort(seeds.begin(), seeds.end(),
                     [](const Seed& a, const Seed& b) { return a.support.log_ratio > b.support.log_ratio; });
    if (seeds.size() > kGrownPerAnchor) seeds.resize(kGrownPerAnchor);
    std::optional<WindowTrack> best;
    for (Seed& seed : seeds) {
      std::ranges::copy(seed.support.bearings, std::back_inserter(seed.bearings));
      auto track = grow_track(window_, seed.bearings, is_free_);
      if (track && (!best || track->log_ratio > best->log_ratio)) best = std::move(track);
    }
    if (!best || best->log_ratio < least_log_ratio_) return;
    for (const std::size_t bearing : best->bearing_of_scan) {
      if (bearing != kNoBearing) is_free_[bearing] = 0;
    }
    tracks_.push_back(std::move(*best));
  }

  const BearingWindow& window_;
  std::vector<char>& is_free_;
  SupportSearch support_;
  double least_log_ratio_;
  std::size_t pairs_tried_ = 0;
  std::vector<WindowTrack> tracks_;
};

}  // namespace

std::vector<WindowTrack> find_tracks(const BearingWindow& window, const SearchRound& round,
                                     std::vector<char>& is_free) {
  const auto picks = pick_scans(window);
  Search search(window, round, is_free);
  for (const Combination<3>& triple : choose_triples(window, picks)) search.try_triple(triple.scans);
  for (const Combination<4>& pairs : choose_pairs(window, picks)) search.try_pairs(pairs.scans);
  return search.take_tracks();
}

}  // namespace alidade
