// SPDX-License-Identifier: Apache-2.0
#include "geometry/marker_places.h"

#include <algorithm>
#include <cmath>

namespace alidade {
namespace {

using Constraints = std::span<const PlaneConstraint>;

constexpr double kLeastDeterminant = 0.03;  // of three unit normals: below it they meet too flatly
constexpr double kSigmas = 5.0;             // by which a distance may be off

struct Place {
  Eigen::Vector3d p_world;
  double variance;  // of the worst direction, about, m²
  int support;      // how many planes of the point pass there
};

struct PointPlaces {
  Eigen::Vector3d p_body;
  std::vector<Place> places;
};

int count_near(Constraints planes, const Eigen::Vector3d& p_world, double gate_chi2, double variance) {
  return static_cast<int>(std::count_if(planes.begin(), planes.end(), [&](const PlaneConstraint& c) {
    const double r = distance(c.plane_world, p_world);
    return r * r <= gate_chi2 * (1.0 / c.weight + variance);
  }));
}

std::vector<Place> meeting_points(Constraints planes, double gate_chi2, int most) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const Eigen::Vector3d& a = planes[i].plane_world.normal;
      const Eigen::Vector3d& b = planes[j].plane_world.normal;
      const Eigen::Vector3d line = a.cross(b);
      for (std::size_t k = j + 1; k < planes.size(); ++k) {
        const Eigen::Vector3d& c = planes[k].plane_world.normal;
        const double determinant = line.dot(c);
        if (!(std::abs(determinant) > kLeastDeterminant)) continue;
        const Eigen::Vector3d u = b.cross(c) / determinant, v = c.cross(a) / determinant, w = line / determinant;
        const Eigen::Vector3d p =
            planes[i].plane_world.offset * u + planes[j].plane_world.offset * v + planes[k].plane_world.offset * w;
        const double variance = u.squaredNorm() / planes[i].weight + v.squaredNorm() / planes[j].weight +
                                w.squaredNorm() / planes[k].weight;
        places.push_back({p, variance, count_near(planes, p, gate_chi2, variance)});
      }
    }
  }
  // Of equal support the sharper ones.
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.support != b.support ? a.support > b.support : a.variance < b.variance;
  });
  if (places.size() > static_cast<std::size_t>(most)) places.resize(static_cast<std::size_t>(most));
  return places;
}

std::vector<PointPlaces> places_by_point(Constraints constraints, double gate_chi2, int most) {
  std::vector<PointPlaces> points;
  while (!constraints.empty()) {
    const Eigen::Vector3d p_body = constraints.front().p_body;
    const auto end = std::find_if(constraints.begin(), constraints.end(),
                                  [&](const PlaneConstraint& c) { return c.p_body != p_body; });
    const auto run = static_cast<std::size_t>(end - constraints.begin());
    std::vector<Place> places = meeting_points(constraints.first(run), gate_chi2, most);
    if (!places.empty()) points.push_back({p_body, std::move(places)});
    constraints = constraints.subspan(run);
  }
  return points;
}

bool are_as_far_apart(const Place& a, const Place& b, double expected) {
  const double off = (a.p_world - b.p_world).norm() - expected;
  return off * off <= kSigmas * kSigmas * (a.variance + b.variance);
}

// Axes of a triangle: along its first side, in its plane across that, and normal to it. Nearly collinear corners make
// poor axes and poor hypotheses, which others outdo.
Eigen::Matrix3d axes_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  Eigen::Matrix3d axes;
  axes.col(0) = (b - a).normalized();
  axes.col(2) = axes.col(0).cross(c - a).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

struct Hypothesis {
  Eigen::Isometry3d T_world_body;
  int fits;
};

class PlaceSearch {
 public:
  PlaceSearch(Constraints constraints, double gate_chi2) : constraints_(constraints), gate_chi2_(gate_chi2) {}

  // Places of three points whose distances are right.
  void look_at(const PointPlaces& a, const PointPlaces& b, const PointPlaces& c) {
    const double ab = (a.p_body - b.p_body).norm();
    const double bc = (b.p_body - c.p_body).norm();
    const double ca = (c.p_body - a.p_body).norm();
    const Eigen::Matrix3d axes_body = axes_of(a.p_body, b.p_body, c.p_body);
    const Eigen::Vector3d centre_body = (a.p_body + b.p_body + c.p_body) / 3.0;
    for (const Place& at_a : a.places) {
      for (const Place& at_b : b.places) {
        if (!are_as_far_apart(at_a, at_b, ab)) continue;
        for (const Place& at_c : c.places) {
          if (!are_as_far_apart(at_b, at_c, bc) || !are_as_far_apart(at_c, at_a, ca)) continue;
          Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
          T.linear() = axes_of(at_a.p_world, at_b.p_world, at_c.p_world) * axes_body.transpose();
          T.translation() = (at_a.p_world + at_b.p_world + at_c.p_world) / 3.0 - T.linear() * centre_body;
          add(T, at_a.variance + at_b.variance + at_c.variance);
          if (found_.size() >= kMost) return;
        }
      }
    }
  }

  std::vector<Eigen::Isometry3d> best(int most) {
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Hypothesis& a, const Hypothesis& b) { return a.fits > b.fits; });
    std::vector<Eigen::Isometry3d> poses;
    for (const Hypothesis& hypothesis : found_) {
      if (poses.size() < static_cast<std::size_t>(most)) poses.push_back(hypothesis.T_world_body);
    }
    return poses;
  }

 private:
  static constexpr std::size_t kMost = 400;  // bounds the time where nearly everything fits

  void add(const Eigen::Isometry3d& T, double variance) {
    if (!T.matrix().allFinite()) return;
    const auto fits = std::count_if(constraints_.begin(), constraints_.end(), [&](const PlaneConstraint& c) {
      const double r = distance(c.plane_world, T * c.p_body);
      return r * r <= gate_chi2_ * (1.0 / c.weight + variance);
    });
    found_.push_back({T, static_cast<int>(fits)});
  }

  Constraints constraints_;
  double gate_chi2_;
  std::vector<Hypothesis> found_;
};

}  // namespace

std::vector<Eigen::Isometry3d> poses_from_places(Constraints constraints, double gate_chi2, int most_places,
                                                 int most_poses) {
  const std::vector<PointPlaces> points = places_by_point(constraints, gate_chi2, most_places);
  PlaceSearch search(constraints, gate_chi2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = j + 1; k < points.size(); ++k) search.look_at(points[i], points[j], points[k]);
    }
  }
  return search.best(most_poses);
}

}  // namespace alidade
