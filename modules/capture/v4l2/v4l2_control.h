// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alidade {

enum class V4l2ControlKind { Integer, Boolean, Choice, Command, Text };

/// A control as its driver describes it.
struct V4l2Control {
  std::uint32_t id = 0;  ///< V4L2_CID_...
  std::string name;      ///< see v4l2_control_name
  V4l2ControlKind kind = V4l2ControlKind::Integer;
  std::int64_t least = 0, most = 0, step = 1;  ///< of a text: its length
  bool is_readable = true;
  bool is_writable = true;
  std::vector<std::pair<std::int64_t, std::string>> entries;  ///< of a choice: value and name
};

/// The name of a control from its title, as v4l2-ctl has it: letters and digits in lower case, an underscore for
/// whatever stands between them ("White Balance, Automatic" is "white_balance_automatic").
std::string v4l2_control_name(std::string_view title);

/// The value that `text` means for the control: an integer (decimal, or hexadecimal behind 0x) in its range and of its
/// steps; for a boolean also on, off, true, false; for a choice also the name of an entry; anything for a command. Not
/// for text. Throws CameraError (Refused) naming `device`, what is wrong and what the control takes.
std::int64_t parse_v4l2_value(const std::string& device, const V4l2Control& control, std::string_view text);

/// "0 to 255 by 1"; empty where there is no range.
std::string range_text(const V4l2Control& control);

/// The control of that name. Throws CameraError (Refused) naming the nearest one.
const V4l2Control& find_v4l2_control(const std::string& device, std::span<const V4l2Control> controls,
                                     std::string_view name);

}  // namespace alidade
