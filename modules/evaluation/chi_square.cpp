// SPDX-License-Identifier: Apache-2.0
#include "evaluation/chi_square.h"

#include <stdexcept>

#include <Eigen/Core>
#include <unsupported/Eigen/SpecialFunctions>

namespace alidade {

double chi_square_quantile(double degrees, double probability) {
  if (!(degrees > 0)) throw std::invalid_argument("chi_square_quantile: degrees must be > 0");
  if (!(probability > 0 && probability < 1)) {
    throw std::invalid_argument("chi_square_quantile: probability must lie between 0 and 1");
  }
  const auto probability_below = [degrees](double x) { return Eigen::numext::igamma(0.5 * degrees, 0.5 * x); };
  double low = 0, high = degrees;
  while (probability_below(high) < probability) high *= 2;
  while (high - low > 1e-10 * high) {
    const double middle = 0.5 * (low + high);
    (probability_below(middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace alidade
