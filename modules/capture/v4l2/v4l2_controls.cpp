// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_controls.h"

#include <algorithm>
#include <string>
#include <utility>

#include <linux/videodev2.h>

namespace alidade {
namespace {

std::optional<V4l2ControlKind> kind_of(std::uint32_t type) {
  switch (type) {
    case V4L2_CTRL_TYPE_INTEGER:
    case V4L2_CTRL_TYPE_INTEGER64:
    case V4L2_CTRL_TYPE_BITMASK:
      return V4l2ControlKind::Integer;
    case V4L2_CTRL_TYPE_BOOLEAN:
      return V4l2ControlKind::Boolean;
    case V4L2_CTRL_TYPE_MENU:
    case V4L2_CTRL_TYPE_INTEGER_MENU:
      return V4l2ControlKind::Choice;
    case V4L2_CTRL_TYPE_BUTTON:
      return V4l2ControlKind::Command;
    case V4L2_CTRL_TYPE_STRING:
      return V4l2ControlKind::Text;
    default:  // titles of groups, matrices
      return std::nullopt;
  }
}

std::vector<std::pair<std::int64_t, std::string>> entries_of(const V4l2Device& device,
                                                             const v4l2_query_ext_ctrl& told) {
  std::vector<std::pair<std::int64_t, std::string>> entries;
  for (std::int64_t i = told.minimum; i <= told.maximum; ++i) {
    v4l2_querymenu entry{};
    entry.id = told.id;
    entry.index = static_cast<__u32>(i);
    if (device.call(VIDIOC_QUERYMENU, &entry) != 0) continue;  // menus have holes
    entries.emplace_back(i, told.type == V4L2_CTRL_TYPE_INTEGER_MENU ? std::to_string(entry.value)
                                                                     : reinterpret_cast<const char*>(entry.name));
  }
  return entries;
}

V4l2Control control_of(const V4l2Device& device, const v4l2_query_ext_ctrl& told, V4l2ControlKind kind) {
  V4l2Control control;
  control.id = told.id;
  control.name = v4l2_control_name(told.name);
  control.kind = kind;
  control.least = told.minimum;
  control.most = told.type == V4L2_CTRL_TYPE_BITMASK ? static_cast<__u32>(told.maximum) : told.maximum;
  control.step = told.type == V4L2_CTRL_TYPE_BITMASK ? 1 : static_cast<std::int64_t>(told.step);
  control.is_readable = !(told.flags & V4L2_CTRL_FLAG_WRITE_ONLY);
  control.is_writable = !(told.flags & V4L2_CTRL_FLAG_READ_ONLY);
  if (kind == V4l2ControlKind::Choice) control.entries = entries_of(device, told);
  return control;
}

v4l2_ext_controls one_of(v4l2_ext_control& control) {
  v4l2_ext_controls call{};
  call.which = V4L2_CTRL_WHICH_CUR_VAL;
  call.count = 1;
  call.controls = &control;
  return call;
}

/// A control's value fits the field of its type: 64 bits for INTEGER64, else 32.
bool is_wide(const V4l2Device& device, std::uint32_t id) {
  v4l2_query_ext_ctrl told{};
  told.id = id;
  return device.call(VIDIOC_QUERY_EXT_CTRL, &told) == 0 && told.type == V4L2_CTRL_TYPE_INTEGER64;
}

void send(const V4l2Device& device, const V4l2Control& control, v4l2_ext_control& value) {
  if (!control.is_writable)
    throw v4l2_refusal(device.path(), "set " + control.name, "it can only be read", "leave it out");
  v4l2_ext_controls call = one_of(value);
  device.require(VIDIOC_S_EXT_CTRLS, &call, "set " + control.name);
}

std::string read_text(const V4l2Device& device, const V4l2Control& control) {
  std::string text(static_cast<std::size_t>(control.most) + 1, '\0');
  v4l2_ext_control value{};
  value.id = control.id;
  value.size = static_cast<__u32>(text.size());
  value.string = text.data();
  v4l2_ext_controls call = one_of(value);
  return device.call(VIDIOC_G_EXT_CTRLS, &call) == 0 ? std::string(text.c_str()) : "";
}

void write_text(const V4l2Device& device, const V4l2Control& control, std::string text) {
  v4l2_ext_control value{};
  value.id = control.id;
  value.size = static_cast<__u32>(text.size() + 1);
  value.string = text.data();
  send(device, control, value);
}

std::string value_text(const V4l2Device& device, const V4l2Control& control) {
  if (!control.is_readable || control.kind == V4l2ControlKind::Command) return "";
  if (control.kind == V4l2ControlKind::Text) return read_text(device, control);
  const auto value = read_v4l2_control(device, control.id);
  if (!value) return "";
  const auto entry = std::find_if(control.entries.begin(), control.entries.end(),
                                  [&](const auto& candidate) { return candidate.first == *value; });
  return entry == control.entries.end() ? std::to_string(*value) : entry->second;
}

std::string kind_text(V4l2ControlKind kind) {
  switch (kind) {
    case V4l2ControlKind::Integer:
      return "integer";
    case V4l2ControlKind::Boolean:
      return "boolean";
    case V4l2ControlKind::Choice:
      return "choice";
    case V4l2ControlKind::Command:
      return "command";
    case V4l2ControlKind::Text:
      return "text";
  }
  return "";
}

}  // namespace

std::vector<V4l2Control> v4l2_controls(const V4l2Device& device) {
  std::vector<V4l2Control> controls;
  v4l2_query_ext_ctrl told{};
  told.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  while (device.call(VIDIOC_QUERY_EXT_CTRL, &told) == 0) {
    const auto kind = kind_of(told.type);
    if (kind && !(told.flags & V4L2_CTRL_FLAG_DISABLED)) controls.push_back(control_of(device, told, *kind));
    told.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  return controls;
}

std::optional<std::int64_t> read_v4l2_control(const V4l2Device& device, std::uint32_t id) {
  v4l2_ext_control value{};
  value.id = id;
  v4l2_ext_controls call = one_of(value);
  if (device.call(VIDIOC_G_EXT_CTRLS, &call) != 0) return std::nullopt;
  return is_wide(device, id) ? value.value64 : value.value;
}

void write_v4l2_control(const V4l2Device& device, const V4l2Control& control, std::int64_t number) {
  v4l2_ext_control value{};
  value.id = control.id;
  value.value64 = number;  // little-endian: the 32-bit value lies in its first half
  send(device, control, value);
}

void set_v4l2_control(const V4l2Device& device, std::string_view name, std::string_view text) {
  const std::vector<V4l2Control> controls = v4l2_controls(device);
  const V4l2Control& control = find_v4l2_control(device.path(), controls, name);
  if (control.kind == V4l2ControlKind::Text) {
    write_text(device, control, std::string(text));
  } else {
    write_v4l2_control(device, control, parse_v4l2_value(device.path(), control, text));
  }
}

std::vector<ListedControl> list_v4l2_controls(const V4l2Device& device) {
  std::vector<ListedControl> listed;
  for (const V4l2Control& control : v4l2_controls(device)) {
    ListedControl& entry = listed.emplace_back();
    entry.name = control.name;
    entry.kind = kind_text(control.kind);
    entry.value = value_text(device, control);
    entry.range = range_text(control);
    entry.is_writable = control.is_writable;
    for (const auto& [value, name] : control.entries) entry.choices.push_back(name);
  }
  return listed;
}

}  // namespace alidade
