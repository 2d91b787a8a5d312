// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace alidade {

/// The value that a χ² variable of `degrees` degrees of freedom stays below with `probability`; relative accuracy
/// 1e-9. Throws std::invalid_argument unless degrees > 0 and 0 < probability < 1.
double chi_square_quantile(double degrees, double probability);

}  // namespace alidade
