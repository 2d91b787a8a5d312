// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace alidade {

/// Says what is broken about the bytes of an image file where decoders keep silent and paint the missing part grey:
/// a JPEG without its end or with damaged code, a PNG without its end. Empty where nothing is found; other formats are
/// left to their decoders.
std::optional<std::string> find_image_damage(std::string_view bytes);

}  // namespace alidade
