// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/camera_opening.h"

#include <array>
#include <mutex>

#include <arpa/inet.h>
#include <arv.h>
#include <netdb.h>

#include "capture/genicam/gvcp.h"

namespace alidade {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPatience{600};

GObjectPointer<ArvCamera> camera_of(GObjectPointer<ArvDevice> device, const std::string& source) {
  AravisFault fault;
  GObjectPointer<ArvCamera> camera(arv_camera_new_with_device(device.get(), fault.out()));  // takes its own reference
  fault.check(source, "open");
  return camera;
}

[[noreturn]] void throw_busy(const std::string& source) {
  throw CameraError(CameraTrouble::Busy, source, "open", "another program controls the camera",
                    "end it; after a crash the camera lets go within a few seconds");
}

OpenedCamera open_gige(const std::string& address, const std::string& source) {
  const auto identity = ask_gige_camera(address, kPatience);
  if (!identity) {
    throw CameraError(CameraTrouble::Gone, source, "open", "no GigE Vision camera answers at " + address,
                      "check power, cable and address");
  }
  if (!may_control_gige_camera(address, kPatience)) throw_busy(source);
  const GObjectPointer<GInetAddress> host(g_inet_address_new_from_string(identity->host_address.c_str()));
  const GObjectPointer<GInetAddress> there(g_inet_address_new_from_string(address.c_str()));
  AravisFault fault;
  GObjectPointer<ArvDevice> device(arv_gv_device_new(host.get(), there.get(), fault.out()));
  fault.check(source, "open");
  if (!arv_gv_device_is_controller(ARV_GV_DEVICE(device.get()))) throw_busy(source);
  return {camera_of(std::move(device), source), address};
}

// The place in Aravis' list of the camera with that serial number or id.
std::optional<unsigned> find_listed(const std::string& id) {
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
    for (const auto name_of_device : {arv_get_device_id, arv_get_device_physical_id, arv_get_device_serial_nbr}) {
      const char* const name = name_of_device(i);
      if (name && id == name) return i;
    }
  }
  return std::nullopt;
}

OpenedCamera open_listed(const std::string& id, const std::string& source) {
  static std::mutex list;  // Aravis' list is one for the whole program
  const std::scoped_lock lock(list);
  arv_update_device_list();
  const auto index = find_listed(id);
  if (!index) {
    throw CameraError(CameraTrouble::Gone, source, "open", "no GenICam camera of that serial number or id answers",
                      "give its network address; 'alidade devices' lists the cameras");
  }
  const char* const protocol = arv_get_device_protocol(*index);
  const std::string address = arv_get_device_address(*index) ? arv_get_device_address(*index) : "";
  if (protocol && std::string_view(protocol) == "GigEVision") return open_gige(address, source);
  AravisFault fault;
  GObjectPointer<ArvDevice> device(arv_open_device(arv_get_device_id(*index), fault.out()));
  fault.check(source, "open");
  if (!device) {
    throw CameraError(CameraTrouble::Gone, source, "open", "the camera does not open", "plug it in again");
  }
  return {camera_of(std::move(device), source), ""};
}

}  // namespace

std::string address_of(const std::string& id) {
  in_addr numeric{};
  if (inet_pton(AF_INET, id.c_str(), &numeric) == 1) return id;
  if (id != "localhost" && id.find('.') == std::string::npos) return "";  // a serial number is no host: ask nobody
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(id.c_str(), nullptr, &hints, &found) != 0) return "";
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> guard(found, freeaddrinfo);
  std::array<char, INET_ADDRSTRLEN> text{};
  const auto* const address = reinterpret_cast<const sockaddr_in*>(found->ai_addr);
  return inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) ? text.data() : "";
}

OpenedCamera open_camera(const std::string& id, const std::string& source) {
  if (id.empty()) {
    throw CameraError(CameraTrouble::Refused, source, "open", "names no camera",
                      "give a network address, serial number or id: genicam:192.168.1.20");
  }
  silence_aravis();
  const std::string address = address_of(id);
  return address.empty() ? open_listed(id, source) : open_gige(address, source);
}

}  // namespace alidade
