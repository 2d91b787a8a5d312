// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace alidade {

/// What a negative return value of libav's means, in its words.
std::string libav_message(int error);

}  // namespace alidade
