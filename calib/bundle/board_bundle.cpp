// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/board_bundle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/QR>

#include "calib/bundle/bundle_priors.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

// The most columns of one view: intrinsics, pose of the camera, warp, pose of the board.
constexpr int kMostColumns = 4 + kMostCoefficients + 6 + 2 + 6;
using ViewJacobian =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, Eigen::Dynamic, kMostColumns>;

void require_fitting(const BoardBundle& bundle, const BoardShape& shape, std::span<const BundleView> views) {
  const auto in = [](int i, std::size_t size) { return i >= 0 && static_cast<std::size_t>(i) < size; };
  for (const BundleView& view : views) {
    if (!in(view.camera, bundle.cameras.size())) throw std::invalid_argument("a view of no camera");
    if (!in(view.frame, bundle.T_rig_board.size())) throw std::invalid_argument("a view of no frame");
    if (view.weights.size() != view.corners.size()) throw std::invalid_argument("a weight per corner is wanted");
    for (const BoardCorner& corner : view.corners) {
      if (!in(corner.id, shape.corners_m.size())) throw std::invalid_argument("a corner that the board does not have");
    }
  }
}

// A view's part of the equations: which columns of the shared parameters its first ones are, the last six are the
// frame.
struct ViewColumns {
  std::vector<int> shared;
  int intrinsics = 0, pose = -1, warp = -1, frame = 0, size = 0;
};

ViewColumns columns_of(const BundleLayout& layout, int camera) {
  ViewColumns columns;
  const auto append = [&](int first, int count) {
    const int at = static_cast<int>(columns.shared.size());
    for (int i = 0; i < count; ++i) columns.shared.push_back(first + i);
    return at;
  };
  columns.intrinsics = append(layout.intrinsics_at(camera), static_cast<int>(layout.free_of(camera).size()));
  if (layout.camera_poses && camera > 0) columns.pose = append(layout.pose_at(camera), 6);
  if (layout.warp) columns.warp = append(layout.warp_at, 2);
  columns.frame = static_cast<int>(columns.shared.size());
  columns.size = columns.frame + 6;
  return columns;
}

// What all corners of a view share.
struct ViewGeometry {
  ViewGeometry(const BoardBundle& bundle, const BundleView& view)
      : camera(bundle.cameras[static_cast<std::size_t>(view.camera)].camera),
        T_camera_board(bundle.cameras[static_cast<std::size_t>(view.camera)].T_rig_camera.inverse() *
                       bundle.T_rig_board[static_cast<std::size_t>(view.frame)]) {}

  const Camera& camera;
  Eigen::Isometry3d T_camera_board;
};

bool is_in_front(const Camera& camera, const Eigen::Vector3d& p) {
  return std::holds_alternative<Fisheye>(camera.distortion) ? p.squaredNorm() > 0 : p.z() > 1e-9;
}

Eigen::Vector2d residual(const Camera& camera, const Eigen::Vector2d& xy, const Eigen::Vector2d& pixel) {
  return Eigen::Vector2d(camera.fx * xy.x() + camera.cx, camera.fy * xy.y() + camera.cy) - pixel;
}

const Eigen::Vector2d kBehind(1e3, 1e3);  // px: a step that turns the board behind the camera must look bad

struct ViewLinearisation {
  ViewJacobian J;
  Eigen::VectorXd r;
};

// A corner before the camera.
struct SeenCorner {
  int id;
  Eigen::Vector3d p_board, p_camera;
  DistortedPoint imaged;
};

using CornerJacobian = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMostColumns>;

void differentiate(const ViewGeometry& geometry, const BoardShape& shape, const SeenCorner& corner,
                   const ViewColumns& columns, const std::vector<int>& intrinsics, CornerJacobian& J) {
  const Camera& camera = geometry.camera;
  const Eigen::Vector3d& p = corner.p_camera;
  const Eigen::Vector2d focal(camera.fx, camera.fy);
  const Eigen::Matrix<double, 2, 3> J_point = focal.asDiagonal() * corner.imaged.J_xy_point;
  if (!intrinsics.empty()) {
    const Eigen::Vector2d& xy = corner.imaged.xy;
    const auto J_coefficients = coefficient_jacobian(camera.distortion, p);
    for (std::size_t i = 0; i < intrinsics.size(); ++i) {
      const int place = intrinsics[i], column = columns.intrinsics + static_cast<int>(i);
      if (place < 4) {
        J(place % 2, column) = place < 2 ? xy[place] : 1.0;
      } else {
        J.col(column) = focal.cwiseProduct(J_coefficients.col(place - 4));
      }
    }
  }
  if (columns.pose >= 0) {
    J.middleCols<3>(columns.pose) = -J_point;
    J.middleCols<3>(columns.pose + 3) = J_point * skew(p);
  }
  const Eigen::Matrix<double, 2, 3> J_board = J_point * geometry.T_camera_board.linear();
  if (columns.warp >= 0) {
    J.middleCols<2>(columns.warp) = J_board.col(2) * shape.bulge[static_cast<std::size_t>(corner.id)].transpose();
  }
  J.middleCols<3>(columns.frame) = J_board;
  J.middleCols<3>(columns.frame + 3) = -J_board * skew(corner.p_board);
}

ViewLinearisation linearise(const BoardBundle& bundle, const BoardShape& shape, const BundleView& view,
                            const ViewColumns& columns, const std::vector<int>& intrinsics) {
  const ViewGeometry geometry(bundle, view);
  const auto rows = static_cast<Eigen::Index>(2 * view.corners.size());
  ViewLinearisation linear{ViewJacobian::Zero(rows, columns.size), Eigen::VectorXd::Zero(rows)};
  CornerJacobian J(2, columns.size);
  for (std::size_t i = 0; i < view.corners.size(); ++i) {
    if (view.weights[i] <= 0) continue;
    const BoardCorner& corner = view.corners[i];
    const double scale = std::sqrt(view.weights[i]) / corner.sigma_px;
    const Eigen::Vector3d p_board = shape.corner(corner.id, bundle.warp);
    const Eigen::Vector3d p = geometry.T_camera_board * p_board;
    const auto row = static_cast<Eigen::Index>(2 * i);
    if (!is_in_front(geometry.camera, p)) {
      linear.r.segment<2>(row) = scale * kBehind;
      continue;
    }
    const SeenCorner seen{corner.id, p_board, p, distort(geometry.camera.distortion, p)};
    J.setZero();
    differentiate(geometry, shape, seen, columns, intrinsics, J);
    linear.J.middleRows<2>(row) = scale * J;
    linear.r.segment<2>(row) = scale * residual(geometry.camera, seen.imaged.xy, corner.pixel);
  }
  return linear;
}

void add_view(const ViewLinearisation& linear, const ViewColumns& columns, std::size_t frame, BundleEquations& e) {
  const Eigen::MatrixXd H = linear.J.transpose() * linear.J;
  const Eigen::VectorXd g = linear.J.transpose() * linear.r;
  e.H(columns.shared, columns.shared) += H.topLeftCorner(columns.frame, columns.frame);
  e.g(columns.shared) += g.head(columns.frame);
  e.H_frame[frame] += H.bottomRightCorner<6, 6>();
  e.g_frame[frame] += g.tail<6>();
  e.H_frame_shared[frame](Eigen::all, columns.shared) += H.bottomLeftCorner(6, columns.frame);
  e.cost += linear.r.squaredNorm();
}

// A corner moves its own pixel only, as its board's translation does.
void add_corners(const ViewLinearisation& linear, const ViewColumns& columns, const BundleLayout& layout,
                 const BundleView& view, BundleEquations& e) {
  const auto frame = static_cast<std::size_t>(view.frame);
  for (std::size_t i = 0; i < view.corners.size(); ++i) {
    if (view.weights[i] <= 0) continue;
    const auto row = static_cast<Eigen::Index>(2 * i);
    const Eigen::Matrix<double, 2, 3> J = linear.J.block<2, 3>(row, columns.frame);
    const int at = layout.corners_at + 3 * view.corners[i].id;
    e.H.block<3, 3>(at, at) += J.transpose() * J;
    e.g.segment<3>(at) += J.transpose() * linear.r.segment<2>(row);
    e.H_frame_shared[frame].middleCols<3>(at) += linear.J.block<2, 6>(row, columns.frame).transpose() * J;
    for (int j = 0; j < columns.frame; ++j) {
      const Eigen::RowVector3d cross = linear.J.block<2, 1>(row, j).transpose() * J;
      const int other = columns.shared[static_cast<std::size_t>(j)];
      e.H.block<1, 3>(other, at) += cross;
      e.H.block<3, 1>(at, other) += cross.transpose();
    }
  }
}

}  // namespace

namespace {

Eigen::Matrix<double, Eigen::Dynamic, 7> rigid_modes(const std::vector<Eigen::Vector3d>& corners,
                                                     const Eigen::Vector3d& centre) {
  Eigen::Matrix<double, Eigen::Dynamic, 7> modes(3 * static_cast<Eigen::Index>(corners.size()), 7);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d p = corners[i] - centre;
    modes.middleRows<3>(3 * static_cast<Eigen::Index>(i)) << Eigen::Matrix3d::Identity(), -skew(p), p;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(modes);
  return qr.householderQ() * Eigen::MatrixXd::Identity(modes.rows(), 7);
}

}  // namespace

BoardShape shape_of(const Board& board) {
  BoardShape shape;
  shape.corners_m = corners_m(board);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& corner : shape.corners_m) box.extend(corner);
  shape.extent_m = box.diagonal().norm();
  shape.rigid_modes = rigid_modes(shape.corners_m, box.center());
  for (const Eigen::Vector3d& corner : shape.corners_m) {
    const Eigen::Vector2d uv = 2.0 * (corner - box.center()).head<2>().cwiseQuotient(box.sizes().head<2>());
    shape.bulge.push_back(Eigen::Vector2d::Ones() - uv.cwiseAbs2());
  }
  return shape;
}

BundleLayout::BundleLayout(const BoardBundle& bundle, const BundleFreedom& freedom)
    : intrinsics(freedom.intrinsics), camera_poses(freedom.camera_poses), warp(freedom.warp), corners(freedom.corners) {
  intrinsics.resize(bundle.cameras.size());
  for (const auto& of_camera : intrinsics) {
    starts.push_back(pose_start);
    pose_start += static_cast<int>(of_camera.size());
  }
  warp_at = pose_start + (camera_poses ? 6 * (static_cast<int>(bundle.cameras.size()) - 1) : 0);
  corners_at = warp_at + (warp ? 2 : 0);
  size = corners_at + (corners ? 3 * static_cast<int>(bundle.warp.offsets_m.size()) : 0);
}

BundleEquations bundle_equations(const BoardBundle& bundle, const BoardShape& shape, std::span<const BundleView> views,
                                 const BundleFreedom& freedom) {
  require_fitting(bundle, shape, views);
  const BundleLayout layout(bundle, freedom);
  const std::size_t frames = bundle.T_rig_board.size();
  BundleEquations e{Eigen::MatrixXd::Zero(layout.size, layout.size),
                    Eigen::VectorXd::Zero(layout.size),
                    std::vector<Matrix6d>(frames, Matrix6d::Zero()),
                    std::vector<Vector6d>(frames, Vector6d::Zero()),
                    {},
                    0.0};
  e.H_frame_shared.assign(frames, Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, layout.size));
  for (const BundleView& view : views) {
    const ViewColumns columns = columns_of(layout, view.camera);
    const ViewLinearisation linear = linearise(bundle, shape, view, columns, layout.free_of(view.camera));
    add_view(linear, columns, static_cast<std::size_t>(view.frame), e);
    if (layout.corners) add_corners(linear, columns, layout, view, e);
  }
  for (const BundlePrior& prior : bundle_priors(bundle, shape, freedom)) {
    e.H(prior.place, prior.place) += prior.information;
    e.g[prior.place] += prior.information * prior.value;
    e.cost += prior.information * prior.value * prior.value;
  }
  if (layout.corners) {
    const Eigen::Index at = layout.corners_at, size = layout.size - layout.corners_at;
    const Eigen::VectorXd moved = rigid_part(bundle.warp, shape);
    const double information = rigid_information(shape);
    e.H.block(at, at, size, size) += information * shape.rigid_modes * shape.rigid_modes.transpose();
    e.g.tail(size) += information * shape.rigid_modes * moved;
    e.cost += information * moved.squaredNorm();
  }
  return e;
}

std::vector<Eigen::Vector2d> residuals_px(const BoardBundle& bundle, const BoardShape& shape, const BundleView& view) {
  const ViewGeometry geometry(bundle, view);
  std::vector<Eigen::Vector2d> residuals;
  residuals.reserve(view.corners.size());
  for (const BoardCorner& corner : view.corners) {
    const Eigen::Vector3d p = geometry.T_camera_board * shape.corner(corner.id, bundle.warp);
    residuals.push_back(is_in_front(geometry.camera, p)
                            ? residual(geometry.camera, distort(geometry.camera.distortion, p).xy, corner.pixel)
                            : kBehind);
  }
  return residuals;
}

double bundle_cost(const BoardBundle& bundle, const BoardShape& shape, std::span<const BundleView> views,
                   const BundleFreedom& freedom) {
  require_fitting(bundle, shape, views);
  double cost = 0;
  for (const BundleView& view : views) {
    const auto residuals = residuals_px(bundle, shape, view);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      cost += view.weights[i] * residuals[i].squaredNorm() / (view.corners[i].sigma_px * view.corners[i].sigma_px);
    }
  }
  for (const BundlePrior& prior : bundle_priors(bundle, shape, freedom)) {
    cost += prior.information * prior.value * prior.value;
  }
  if (freedom.corners) cost += rigid_information(shape) * rigid_part(bundle.warp, shape).squaredNorm();
  return cost;
}

}  // namespace alidade
