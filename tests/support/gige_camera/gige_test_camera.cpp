// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "core/errors.h"
#include "tests/support/gige_camera/gige_camera.h"

namespace alidade::test {
namespace {

struct Flags {
  GigeCameraOptions camera;
  std::string size, sensor;
  std::string format = "Mono8";
  std::string pictures;
  std::string log;
  bool is_once = false;
  double exposure_us = 3000;
  double clock_offset_s = 0;
  double resend_delay_ms = 0;
  double pulse_hz = 0;
};

constexpr const char* kFooter = R"(Commands, one a line on standard input:
  stall SECONDS     no exposures for that long
  drop COUNT        the next frames are counted but never sent
  loss SHARE        of packets, from now on
  deaf SECONDS      commands of the client are not answered for that long
  pulse             a signal at line 0: one exposure in hardware trigger mode
  quit

It prints "ready ADDRESS:PORT" once it can be used, and what it sent, as JSON, at its end (quit, SIGTERM, SIGINT).

Example: gige_test_camera --pictures frames/ --fps 30 --log truth.csv
         alidade track camera genicam:127.0.0.1 --camera camera.yaml)";

cv::Size parse_size(const std::string& text) {
  cv::Size size;
  char cross = 0;
  std::istringstream in(text);
  if (!(in >> size.width >> cross >> size.height) || cross != 'x' || size.width < 1 || size.height < 1) {
    throw InputError(text, 0, "is no size", "give one like 640x480");
  }
  return size;
}

void add_flags(CLI::App& app, Flags& flags) {
  CameraSetup& setup = flags.camera.setup;
  SenderOptions& sender = flags.camera.sender;
  app.add_option("--address", setup.address, "of this machine: 127.0.0.1, 127.0.0.2, ...")->capture_default_str();
  app.add_option("--serial", setup.serial, "serial number")->capture_default_str();
  app.add_option("--pictures", flags.pictures, "folder of images to show; else a pattern that spells its number");
  app.add_flag("--once", flags.is_once, "stop streaming after the last image instead of beginning anew");
  app.add_option("--size", flags.size, "px, WxH, of the first region; else of the images, or 512x512");
  app.add_option("--sensor", flags.sensor, "px, WxH, the largest region; else of the images, or 2048x2048");
  app.add_option("--format", flags.format, "pixel format at the start")->capture_default_str();
  app.add_option("--fps", setup.fps_hz, "Hz, at the start")->capture_default_str();
  app.add_option("--exposure", flags.exposure_us, "µs, at the start")->capture_default_str();
  app.add_flag("--auto-exposure", setup.is_exposure_automatic, "on at the start");
  app.add_option("--clock-offset", flags.clock_offset_s,
                 "s that the camera's clock is ahead of the host's monotonic one");
  app.add_option("--clock-rate", flags.camera.clock.rate_error_ppm, "ppm that the camera's clock runs fast");
  app.add_option("--first-frame-id", flags.camera.first_frame_id, "of each acquisition, 1 to 65535")
      ->check(CLI::Range(1, 65535));
  app.add_option("--loss", sender.loss, "share of packets that are lost, resent ones too")->check(CLI::Range(0.0, 1.0));
  app.add_option("--drop", flags.camera.drop_share, "share of frames that are never sent")->check(CLI::Range(0.0, 1.0));
  app.add_option("--seed", sender.seed, "of what is lost and dropped")->capture_default_str();
  app.add_option("--resend-delay", flags.resend_delay_ms, "ms from a request to the resent packet");
  app.add_option("--link", sender.link_mb_per_s, "MB/s that the network carries (GigE: 118); 0: as many as it can")
      ->capture_default_str();
  app.add_option("--kept-frames", sender.kept_frames, "frames that can be sent again")->capture_default_str();
  app.add_option("--pulse", flags.pulse_hz, "Hz, of a signal at line 0");
  app.add_option("--log", flags.log, "CSV of what was exposed: frame id, both clocks' times in ns, picture");
  app.footer(kFooter);
}

GigeCameraOptions camera_options(const Flags& flags) {
  GigeCameraOptions options = flags.camera;
  const std::optional<PayloadFormat> format = find_payload_format(flags.format);
  if (!format) throw InputError(flags.format, 0, "is no format of this camera", "give one like Mono8 or Mono12Packed");
  options.setup.format = *format;
  if (!flags.pictures.empty()) options.setup.sensor = options.setup.size = picture_size(flags.pictures);
  if (!flags.sensor.empty()) options.setup.sensor = parse_size(flags.sensor);
  if (!flags.size.empty()) options.setup.size = parse_size(flags.size);
  const auto& [sensor, size] = std::pair(options.setup.sensor, options.setup.size);
  if (size.width > sensor.width || size.height > sensor.height) {
    throw InputError(flags.size, 0, "is larger than the sensor", "give a larger --sensor");
  }
  options.setup.exposure = std::chrono::microseconds(static_cast<std::int64_t>(flags.exposure_us));
  options.clock.offset = std::chrono::nanoseconds(static_cast<std::int64_t>(flags.clock_offset_s * 1e9));
  options.resend_delay = std::chrono::milliseconds(static_cast<std::int64_t>(flags.resend_delay_ms));
  if (!flags.log.empty()) options.log = flags.log;
  return options;
}

// False: the end.
bool obey(const std::string& line, GigeCamera& camera) {
  std::istringstream in(line);
  std::string command;
  double value = 0;
  in >> command >> value;
  const auto seconds = std::chrono::nanoseconds(static_cast<std::int64_t>(value * 1e9));
  if (command == "stall") camera.stall(seconds);
  if (command == "deaf") camera.ignore_commands(seconds);
  if (command == "drop") camera.drop_frames(static_cast<int>(value));
  if (command == "loss") camera.set_packet_loss(value);
  if (command == "pulse") camera.pulse();
  return command != "quit";
}

// Until a signal, or "quit".
void serve_console(GigeCamera& camera, int signals, double pulse_hz) {
  std::string pending;
  pollfd wanted[2] = {{signals, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}};
  const bool is_pulsing = pulse_hz > 0;
  const std::chrono::nanoseconds period(is_pulsing ? static_cast<std::int64_t>(1e9 / pulse_hz) : 0);
  for (HostTime pulse = HostClock::now() + period;;) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(pulse - HostClock::now());
    const std::int64_t wait_ns = std::max<std::int64_t>(left.count(), 0);
    const timespec wait{wait_ns / 1'000'000'000, wait_ns % 1'000'000'000};
    if (::ppoll(wanted, 2, is_pulsing ? &wait : nullptr, nullptr) == 0) {
      camera.pulse();
      pulse += period;
      continue;
    }
    if ((wanted[0].revents & POLLIN) != 0) return;
    if (wanted[1].revents == 0) continue;
    char bytes[256];
    const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (count <= 0) wanted[1].fd = -1;  // nobody there to command it any more
    pending.append(bytes, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    for (std::size_t end = pending.find('\n'); end != std::string::npos; end = pending.find('\n')) {
      if (!obey(pending.substr(0, end), camera)) return;
      pending.erase(0, end + 1);
    }
  }
}

int run(int argc, char** argv) {
  Flags flags;
  CLI::App app("A GigE Vision camera on loopback, with faults on demand.", "gige_test_camera");
  add_flags(app, flags);
  CLI11_PARSE(app, argc, argv);
  sigset_t ending;
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  sigaddset(&ending, SIGINT);
  sigprocmask(SIG_BLOCK, &ending, nullptr);  // before any other thread
  const int signals = ::signalfd(-1, &ending, SFD_CLOEXEC);
  prctl(PR_SET_TIMERSLACK, 1);
  const GigeCameraOptions options = camera_options(flags);
  GigeCamera camera(options,
                    flags.pictures.empty() ? open_pattern() : open_picture_folder(flags.pictures, !flags.is_once));
  std::cout << fmt::format("ready {}:{}", options.setup.address, kGvcpPort) << std::endl;
  serve_console(camera, signals, flags.pulse_hz);
  const SenderCounts counts = camera.counts();
  std::cout << fmt::format("{{\"packets\":{},\"lost\":{},\"resent\":{},\"unavailable\":{}}}", counts.sent, counts.lost,
                           counts.resent, counts.unavailable)
            << std::endl;
  return 0;
}

}  // namespace
}  // namespace alidade::test

int main(int argc, char** argv) {
  using alidade::ExitCode;
  try {
    return alidade::test::run(argc, argv);
  } catch (const alidade::InputError& error) {
    std::cerr << "gige_test_camera: " << error.what() << '\n';
    return static_cast<int>(ExitCode::BadInput);
  } catch (const alidade::DeviceError& error) {
    std::cerr << "gige_test_camera: " << error.what() << '\n';
    return static_cast<int>(ExitCode::DeviceFault);
  } catch (const std::exception& error) {
    std::cerr << "gige_test_camera: internal fault: " << error.what() << '\n';
    return static_cast<int>(ExitCode::Bug);
  }
}
