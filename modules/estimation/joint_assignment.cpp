// SPDX-License-Identifier: Apache-2.0
#include "estimation/joint_assignment.h"

#include <vector>

namespace alidade {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// All ways for tracks that compete for detections, one after the other.
class Enumeration {
 public:
  Enumeration(const MatrixXd& likelihood, const VectorXd& miss, const std::vector<Index>& tracks)
      : likelihood_(likelihood),
        miss_(miss),
        tracks_(tracks),
        is_taken_(static_cast<std::size_t>(likelihood.cols()), false),
        chosen_(tracks.size()) {}

  // Adds the tracks' rows to `marginals`; leaves them zero where the ways are too many.
  void add_to(MatrixXd& marginals) {
    sums_ = MatrixXd::Zero(static_cast<Index>(tracks_.size()), likelihood_.cols() + 1);
    descend(0, 1.0);
    if (visits_ > kMostVisits) return;
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      const auto row = sums_.row(static_cast<Index>(k));
      if (row.sum() > 0) marginals.row(tracks_[k]) = row / row.sum();
    }
  }

 private:
  static constexpr int kMostVisits = 100000;

  void descend(std::size_t k, double weight) {
    if (++visits_ > kMostVisits) return;
    if (k == tracks_.size()) {
      for (std::size_t i = 0; i < k; ++i) sums_(static_cast<Index>(i), chosen_[i]) += weight;
      return;
    }
    chosen_[k] = likelihood_.cols();
    descend(k + 1, weight * miss_(tracks_[k]));
    for (Index detection = 0; detection < likelihood_.cols(); ++detection) {
      const double own = likelihood_(tracks_[k], detection);
      if (!(own > 0) || is_taken_[static_cast<std::size_t>(detection)]) continue;
      is_taken_[static_cast<std::size_t>(detection)] = true;
      chosen_[k] = detection;
      descend(k + 1, weight * own);
      is_taken_[static_cast<std::size_t>(detection)] = false;
    }
  }

  const MatrixXd& likelihood_;
  const VectorXd& miss_;
  const std::vector<Index>& tracks_;
  std::vector<bool> is_taken_;
  std::vector<Index> chosen_;
  MatrixXd sums_;
  int visits_ = 0;
};

// The track and all that compete with it, directly or through others.
void collect(const MatrixXd& likelihood, Index track, std::vector<bool>& is_visited, std::vector<Index>& cluster) {
  is_visited[static_cast<std::size_t>(track)] = true;
  cluster.push_back(track);
  for (Index other = 0; other < likelihood.rows(); ++other) {
    if (is_visited[static_cast<std::size_t>(other)]) continue;
    if ((likelihood.row(track).array() * likelihood.row(other).array() > 0).any()) {
      collect(likelihood, other, is_visited, cluster);
    }
  }
}

}  // namespace

MatrixXd joint_assignment(const MatrixXd& likelihood, const VectorXd& miss) {
  MatrixXd marginals = MatrixXd::Zero(likelihood.rows(), likelihood.cols() + 1);
  std::vector<bool> is_visited(static_cast<std::size_t>(likelihood.rows()), false);
  for (Index track = 0; track < likelihood.rows(); ++track) {
    if (is_visited[static_cast<std::size_t>(track)]) continue;
    std::vector<Index> cluster;
    collect(likelihood, track, is_visited, cluster);
    Enumeration(likelihood, miss, cluster).add_to(marginals);
  }
  return marginals;
}

}  // namespace alidade
