// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/camera_features.h"

#include <algorithm>
#include <set>
#include <string_view>

#include <arv.h>
#include <fmt/format.h>

#include "capture/genicam/setting_values.h"
#include "core/nearest_name.h"

namespace alidade {
namespace {

void collect(ArvGc* description, const char* name, std::set<std::string>& seen, std::vector<std::string>& names) {
  ArvGcNode* const node = arv_gc_get_node(description, name);
  if (!ARV_IS_GC_FEATURE_NODE(node) || !seen.insert(name).second) return;
  if (!ARV_IS_GC_CATEGORY(node)) {
    names.emplace_back(name);
    return;
  }
  for (const GSList* at = arv_gc_category_get_features(ARV_GC_CATEGORY(node)); at; at = at->next) {
    collect(description, static_cast<const char*>(at->data), seen, names);
  }
}

// One feature that a value is to be written to.
struct Setting {
  ArvGcNode* node;
  const std::string& name;
  const std::string& value;
  const std::string& source;

  std::string operation() const { return fmt::format("set {}={}", name, value); }

  [[noreturn]] void refuse(const std::string& reason, const std::string& remedy) const {
    throw CameraError(CameraTrouble::Refused, source, operation(), reason, remedy);
  }
};

std::string range_text(ArvGcNode* node) {
  AravisFault fault;
  if (ARV_IS_GC_INTEGER(node)) {
    ArvGcInteger* const integer = ARV_GC_INTEGER(node);
    const gint64 least = arv_gc_integer_get_min(integer, fault.out());
    if (fault.happened()) return "";
    const gint64 most = arv_gc_integer_get_max(integer, fault.out());
    if (fault.happened() || (least == G_MININT64 && most == G_MAXINT64)) return "";
    const gint64 step = arv_gc_integer_get_inc(integer, fault.out());
    return !fault.happened() && step > 1 ? fmt::format("{} to {} by {}", least, most, step)
                                         : fmt::format("{} to {}", least, most);
  }
  if (!ARV_IS_GC_FLOAT(node)) return "";
  const double least = arv_gc_float_get_min(ARV_GC_FLOAT(node), fault.out());
  if (fault.happened()) return "";
  const double most = arv_gc_float_get_max(ARV_GC_FLOAT(node), fault.out());
  if (fault.happened() || (least == -G_MAXDOUBLE && most == G_MAXDOUBLE)) return "";
  return fmt::format("{:g} to {:g}", least, most);
}

std::vector<std::string> choices_of(ArvGcNode* node) {
  if (!ARV_IS_GC_ENUMERATION(node)) return {};
  guint count = 0;
  const char** const values =
      arv_gc_enumeration_dup_available_string_values(ARV_GC_ENUMERATION(node), &count, AravisFault().out());
  std::vector<std::string> choices(values, values + (values ? count : 0));
  g_free(values);
  return choices;
}

void write_choice(const Setting& setting, AravisFault& fault) {
  const auto choices = choices_of(setting.node);
  if (std::find(choices.begin(), choices.end(), setting.value) == choices.end()) {
    setting.refuse("is none of its choices", fmt::format("it takes {}", fmt::join(choices, ", ")));
  }
  arv_gc_enumeration_set_string_value(ARV_GC_ENUMERATION(setting.node), setting.value.c_str(), fault.out());
}

void write_boolean(const Setting& setting, AravisFault& fault) {
  const auto value = parse_boolean_setting(setting.value);
  if (!value) setting.refuse("is neither true nor false", "give true or false");
  arv_gc_boolean_set_value(ARV_GC_BOOLEAN(setting.node), *value, fault.out());
}

void write_integer(const Setting& setting, AravisFault& fault) {
  ArvGcInteger* const node = ARV_GC_INTEGER(setting.node);
  const auto value = parse_integer_setting(setting.value);
  const std::string range = range_text(setting.node);
  const std::string remedy = range.empty() ? "give a whole number" : "it takes " + range;
  if (!value) setting.refuse("is not a whole number", remedy);
  if (!range.empty()) {
    const gint64 least = arv_gc_integer_get_min(node, AravisFault().out());
    const gint64 step = std::max<gint64>(1, arv_gc_integer_get_inc(node, AravisFault().out()));
    if (*value < least || *value > arv_gc_integer_get_max(node, AravisFault().out()) || (*value - least) % step != 0) {
      setting.refuse("is out of range", remedy);
    }
  }
  arv_gc_integer_set_value(node, *value, fault.out());
}

void write_float(const Setting& setting, AravisFault& fault) {
  ArvGcFloat* const node = ARV_GC_FLOAT(setting.node);
  const auto value = parse_float_setting(setting.value);
  const std::string range = range_text(setting.node);
  const std::string remedy = range.empty() ? "give a number" : "it takes " + range;
  if (!value) setting.refuse("is not a number", remedy);
  if (!range.empty() && (*value < arv_gc_float_get_min(node, AravisFault().out()) ||
                         *value > arv_gc_float_get_max(node, AravisFault().out()))) {
    setting.refuse("is out of range", remedy);
  }
  arv_gc_float_set_value(node, *value, fault.out());
}

void write_command(const Setting& setting, AravisFault& fault) {
  if (!setting.value.empty() && setting.value != "1") {
    setting.refuse("is a command and takes no value", fmt::format("write {}=1", setting.name));
  }
  arv_gc_command_execute(ARV_GC_COMMAND(setting.node), fault.out());
}

void write_value(const Setting& setting, AravisFault& fault) {
  // Enumerations and booleans are integers, too: they come first.
  if (ARV_IS_GC_ENUMERATION(setting.node)) return write_choice(setting, fault);
  if (ARV_IS_GC_BOOLEAN(setting.node)) return write_boolean(setting, fault);
  if (ARV_IS_GC_COMMAND(setting.node)) return write_command(setting, fault);
  if (ARV_IS_GC_INTEGER(setting.node)) return write_integer(setting, fault);
  if (ARV_IS_GC_FLOAT(setting.node)) return write_float(setting, fault);
  if (!ARV_IS_GC_STRING(setting.node)) setting.refuse("is of a kind that cannot be set", "leave it out");
  arv_gc_string_set_value(ARV_GC_STRING(setting.node), setting.value.c_str(), fault.out());
}

std::string kind_of(ArvGcNode* node) {
  if (ARV_IS_GC_ENUMERATION(node)) return "choice";
  if (ARV_IS_GC_BOOLEAN(node)) return "boolean";
  if (ARV_IS_GC_COMMAND(node)) return "command";
  if (ARV_IS_GC_INTEGER(node)) return "integer";
  if (ARV_IS_GC_FLOAT(node)) return "float";
  return "text";
}

std::string unit_of(ArvGcNode* node) {
  const char* unit = nullptr;
  if (ARV_IS_GC_FLOAT(node)) unit = arv_gc_float_get_unit(ARV_GC_FLOAT(node));
  if (kind_of(node) == "integer") unit = arv_gc_integer_get_unit(ARV_GC_INTEGER(node));
  return unit ? unit : "";
}

std::string value_of(ArvGcNode* node) {
  if (ARV_IS_GC_COMMAND(node)) return "";
  AravisFault fault;
  if (ARV_IS_GC_BOOLEAN(node)) {
    const bool is_set = arv_gc_boolean_get_value(ARV_GC_BOOLEAN(node), fault.out());
    return fault.happened() ? "" : is_set ? "true" : "false";
  }
  const char* const value = arv_gc_feature_node_get_value_as_string(ARV_GC_FEATURE_NODE(node), fault.out());
  return value && !fault.happened() ? value : "";
}

bool is_available(ArvGcNode* node) {
  return ARV_IS_GC_FEATURE_NODE(node) &&
         arv_gc_feature_node_is_implemented(ARV_GC_FEATURE_NODE(node), AravisFault().out()) &&
         arv_gc_feature_node_is_available(ARV_GC_FEATURE_NODE(node), AravisFault().out());
}

bool is_writable(ArvGcNode* node) {
  ArvGcFeatureNode* const feature = ARV_GC_FEATURE_NODE(node);
  return arv_gc_feature_node_get_actual_access_mode(feature) != ARV_GC_ACCESS_MODE_RO &&
         !arv_gc_feature_node_is_locked(feature, AravisFault().out());
}

}  // namespace

std::vector<std::string> feature_names(ArvDevice* device) {
  ArvGc* const description = arv_device_get_genicam(device);
  std::set<std::string> seen;
  std::vector<std::string> names;
  collect(description, "Root", seen, names);
  // Some descriptions leave a category out of the root.
  ArvDomNode* at = ARV_DOM_NODE(arv_dom_document_get_document_element(ARV_DOM_DOCUMENT(description)));
  for (at = arv_dom_node_get_first_child(at); at; at = arv_dom_node_get_next_sibling(at)) {
    if (ARV_IS_GC_CATEGORY(at)) {
      collect(description, arv_gc_feature_node_get_name(ARV_GC_FEATURE_NODE(at)), seen, names);
    }
  }
  return names;
}

bool has_feature(ArvDevice* device, const std::string& name) {
  return is_available(arv_device_get_feature(device, name.c_str()));
}

std::vector<std::string> enumeration_choices(ArvDevice* device, const std::string& name) {
  return choices_of(arv_device_get_feature(device, name.c_str()));
}

ListedControl describe_feature(ArvDevice* device, const std::string& name) {
  ArvGcNode* const node = arv_device_get_feature(device, name.c_str());
  const std::string kind = kind_of(node);
  ListedControl control;
  control.name = name;
  control.kind = kind;
  control.value = value_of(node);
  if (kind == "integer" || kind == "float") control.range = range_text(node);
  control.choices = choices_of(node);
  control.unit = unit_of(node);
  control.is_writable = is_writable(node);
  return control;
}

void set_feature(ArvDevice* device, const std::string& name, const std::string& value, const std::string& source) {
  const Setting setting{arv_device_get_feature(device, name.c_str()), name, value, source};
  if (!ARV_IS_GC_FEATURE_NODE(setting.node) || ARV_IS_GC_CATEGORY(setting.node)) {
    const auto names = feature_names(device);
    const auto nearest = nearest_name(name, std::vector<std::string_view>(names.begin(), names.end()));
    setting.refuse("the camera has no such feature",
                   nearest ? fmt::format("did you mean '{}'?", *nearest) : "'alidade devices' lists its features");
  }
  if (!is_available(setting.node)) setting.refuse("it is not available as the camera is set now", "leave it out");
  if (!is_writable(setting.node)) setting.refuse("it can only be read", "leave it out");
  AravisFault fault;
  write_value(setting, fault);
  fault.check(source, setting.operation());
}

}  // namespace alidade
