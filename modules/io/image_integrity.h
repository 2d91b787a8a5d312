// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace alidade {

/// Says what is broken about the bytes of an image file where decoders paint the missing part grey or print to stderr:
/// a JPEG or PNG without its end, a PNG whose checksums do not fit. Empty where nothing is found; other formats are
/// left to their decoders.
std::optional<std::string> find_image_damage(std::string_view bytes);

}  // namespace alidade
