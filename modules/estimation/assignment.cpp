// SPDX-License-Identifier: Apache-2.0
#include "estimation/assignment.h"

#include <limits>
#include <stdexcept>

namespace alidade {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kNone = -1;

// Gives every row of a cost matrix a column at the least sum; there are at least as many columns as rows.
class Assignment {
 public:
  explicit Assignment(const MatrixXd& cost)
      : cost_(cost),
        row_price_(VectorXd::Zero(cost.rows())),
        column_price_(VectorXd::Zero(cost.cols())),
        row_of_(static_cast<std::size_t>(cost.cols()), kNone) {
    for (Index row = 0; row < cost.rows(); ++row) add(row);
  }

  Index row_of(Index column) const { return row_of_[static_cast<std::size_t>(column)]; }

 private:
  Index& row_of(Index column) { return row_of_[static_cast<std::size_t>(column)]; }

  // Along the shortest path, by reduced costs, from the row to a column that is free.
  void add(Index row) {
    const Index columns = cost_.cols();
    VectorXd distance = VectorXd::Constant(columns, std::numeric_limits<double>::infinity());
    std::vector<Index> before(static_cast<std::size_t>(columns), kNone);  // the column on the path
    std::vector<bool> is_settled(static_cast<std::size_t>(columns), false);
    std::vector<Index> settled;
    double reached = 0.0;
    Index from = row, last = kNone, nearest = kNone;
    for (;;) {
      nearest = kNone;
      for (Index j = 0; j < columns; ++j) {
        const auto place = static_cast<std::size_t>(j);
        if (is_settled[place]) continue;
        const double through = reached + cost_(from, j) - row_price_(from) - column_price_(j);
        if (through < distance(j)) distance(j) = through, before[place] = last;
        if (nearest == kNone || distance(j) < distance(nearest)) nearest = j;
      }
      reached = distance(nearest);
      if (row_of(nearest) == kNone) break;
      is_settled[static_cast<std::size_t>(nearest)] = true;
      settled.push_back(nearest);
      from = row_of(nearest);
      last = nearest;
    }
    row_price_(row) += reached;
    for (const Index j : settled) {
      row_price_(row_of(j)) += reached - distance(j);
      column_price_(j) -= reached - distance(j);
    }
    for (Index j = nearest; j != kNone;) {
      const Index previous = before[static_cast<std::size_t>(j)];
      row_of(j) = previous == kNone ? row : row_of(previous);
      j = previous;
    }
  }

  const MatrixXd& cost_;
  VectorXd row_price_, column_price_;
  std::vector<Index> row_of_;  // by column
};

}  // namespace

std::vector<std::optional<Index>> best_assignment(const MatrixXd& gain) {
  if (gain.hasNaN() || (gain.array() == std::numeric_limits<double>::infinity()).any()) {
    throw std::invalid_argument("best_assignment: a gain is NaN or infinite");
  }
  std::vector<std::optional<Index>> column_of(static_cast<std::size_t>(gain.rows()));
  if (gain.size() == 0) return column_of;
  // A pair without gain costs what no pair costs: every row may then be forced to have one.
  const bool is_wide = gain.rows() <= gain.cols();
  MatrixXd cost = -gain.cwiseMax(0.0);
  if (!is_wide) cost.transposeInPlace();
  const Assignment assignment(cost);
  for (Index j = 0; j < cost.cols(); ++j) {
    const Index i = assignment.row_of(j);
    if (i == kNone || !(cost(i, j) < 0.0)) continue;
    column_of[static_cast<std::size_t>(is_wide ? i : j)] = is_wide ? j : i;
  }
  return column_of;
}

}  // namespace alidade
