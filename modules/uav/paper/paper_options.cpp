// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_options.h"

#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

template <typename Value>
void require(bool is_so, const char* field, const char* bound, Value value) {
  if (!is_so) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

}  // namespace

void validate(const PaperOptions& o) {
  constexpr double kShortest_s = 1e-6;
  require(o.period_s >= kShortest_s, "period_s", ">= 1e-6 s", o.period_s);
  require(o.periods >= 1, "periods", ">= 1", o.periods);
  require(o.pair_threshold_m > 0.0, "pair_threshold_m", "> 0 m", o.pair_threshold_m);
  require(o.alternative_group_m > 0.0, "alternative_group_m", "> 0 m", o.alternative_group_m);
  require(o.proposed_group_m > 0.0, "proposed_group_m", "> 0 m", o.proposed_group_m);
  require(o.shared_bearings >= 0, "shared_bearings", ">= 0", o.shared_bearings);
  if (o.motion == PaperMotion::Still) throw std::invalid_argument("motion must be velocity or acceleration");
  require(o.most_groups >= 1, "most_groups", ">= 1", o.most_groups);
}

double group_threshold_m(const PaperOptions& options) {
  return options.method == PaperMethod::Alternative ? options.alternative_group_m : options.proposed_group_m;
}

}  // namespace alidade
