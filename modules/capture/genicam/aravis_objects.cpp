// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/aravis_objects.h"

#include <cstdlib>
#include <mutex>

#include <arv.h>

namespace alidade {
namespace {

void discard(const gchar*, GLogLevelFlags, const gchar*, gpointer) {}

std::string remedy_of(CameraTrouble trouble) {
  switch (trouble) {
    case CameraTrouble::Gone:
      return "check power, cable and address";
    case CameraTrouble::Busy:
      return "end the other program";
    case CameraTrouble::Denied:
    case CameraTrouble::Refused:
      break;
  }
  return "see 'alidade devices' for what the camera offers";
}

}  // namespace

void ReleaseGObject::operator()(void* object) const {
  g_object_unref(object);
}

AravisFault::~AravisFault() {
  g_clear_error(&error_);
}

GError** AravisFault::out() {
  g_clear_error(&error_);
  return &error_;
}

std::string AravisFault::text() const {
  return error_ ? error_->message : "";
}

CameraTrouble AravisFault::trouble() const {
  if (!error_ || error_->domain != ARV_DEVICE_ERROR) return CameraTrouble::Refused;
  switch (error_->code) {
    case ARV_DEVICE_ERROR_TIMEOUT:
    case ARV_DEVICE_ERROR_NOT_CONNECTED:
    case ARV_DEVICE_ERROR_NOT_FOUND:
    case ARV_DEVICE_ERROR_TRANSFER_ERROR:
      return CameraTrouble::Gone;
    case ARV_DEVICE_ERROR_NOT_CONTROLLER:
    case ARV_DEVICE_ERROR_PROTOCOL_ERROR_ACCESS_DENIED:
    case ARV_DEVICE_ERROR_PROTOCOL_ERROR_BUSY:
      return CameraTrouble::Busy;
    default:
      return CameraTrouble::Refused;
  }
}

void AravisFault::check(const std::string& source, const std::string& operation) const {
  if (happened()) throw CameraError(trouble(), source, operation, text(), remedy_of(trouble()));
}

void silence_aravis() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (std::getenv("ARV_DEBUG")) return;
    arv_debug_enable("all:0");
    const auto levels = static_cast<GLogLevelFlags>(G_LOG_LEVEL_MASK & ~G_LOG_LEVEL_ERROR);
    g_log_set_handler("Aravis", levels, discard, nullptr);
    g_log_set_handler("Aravis-0.8", levels, discard, nullptr);
  });
}

}  // namespace alidade
