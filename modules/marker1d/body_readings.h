// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "camera/line_detector.h"
#include "camera/measurement.h"
#include "estimation/motion_likelihood.h"
#include "geometry/rigid_body.h"

namespace alidade {

/// Detectors by id, ready to be asked what they read of a point of the world.
class DetectorArray {
 public:
  /// Throws std::invalid_argument where two have the same id.
  explicit DetectorArray(std::span<const LineDetector> detectors);

  struct Entry {
    LineDetector detector;
    Eigen::Isometry3d T_detector_world;
  };
  /// Throws std::invalid_argument for an id that none has.
  const Entry& at(int id) const;

 private:
  std::map<int, Entry> entries_;
};

/// The readings of one body within a short time, linearised about one state after another: each at its own time.
class BodyReadings {
 public:
  /// Refers to the detectors. Throws std::invalid_argument for a marker that the body does not have.
  BodyReadings(const DetectorArray& detectors, const RigidBody& body, std::span<const LineReading> readings,
               double variance_factor);

  /// Everything below is about this state (near the readings in time) from here on.
  void linearise(const MotionState& state);

  /// Whether all are of this one moment: they speak of the pose alone.
  bool is_of_pose_at(Timestamp time) const { return is_instant_ && (sightings_.empty() || sightings_[0].time == time); }

  /// Squared whitened residuals; infinite where the detector would not see the marker.
  const Eigen::ArrayXd& chi2() const { return chi2_; }

  /// What the state's covariance makes uncertain of each reading, in units of its own variance: J P Jᵀ / σ².
  Eigen::ArrayXd predicted_variance(const Matrix18d& covariance) const;

  /// The sum over all, each with its weight: one for each χ².
  MotionLikelihood weighted_sum(const Eigen::ArrayXd& weight) const;

  /// The sum where the readings bend away from their linearisation: a column of `bends` is how far, in sigmas, one
  /// standard deviation of the state to either side along one direction takes each of them together (r(+) + r(-) - 2
  /// r). To second order this is noise that they share, ½ bend bendᵀ. Source: Athans, Wishner, Bertolini 1968, the
  /// second-order filter.
  MotionLikelihood weighted_sum(const Eigen::ArrayXd& weight, const Eigen::MatrixXd& bends) const;

  /// Residuals in sigmas.
  const Eigen::VectorXd& residuals() const { return residual_; }

  Eigen::Index size() const { return chi2_.size(); }

 private:
  struct Sighting {
    const DetectorArray::Entry* detector;
    Eigen::Vector3d p_body;
    Timestamp time;
    double value;
    double per_sigma;
  };

  void linearise(const Sighting& sighting, Eigen::Index i);

  std::vector<Sighting> sightings_;
  bool is_instant_ = true;  // all have the same time
  MotionState state_;
  Eigen::Matrix<double, 18, Eigen::Dynamic> J_;  // columns: ∂reading/∂error, per σ
  Eigen::VectorXd residual_;                     // per σ
  Eigen::ArrayXd chi2_;
};

}  // namespace alidade
