// SPDX-License-Identifier: Apache-2.0
// How fast frames of a GigE Vision camera are taken on loopback: by us, and beside it by a bare loop on Aravis, which
// looks at no pixel and copies none. From our test camera, and from Aravis' own.
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include <arv.h>
#include <benchmark/benchmark.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "capture/genicam/genicam_camera.h"
#include "tests/support/gige_camera/camera_process.h"

namespace alidade::test {
namespace {

constexpr const char* kOurAddress = "127.0.0.33";
constexpr const char* kAravisAddress = "127.0.0.1";  // its camera listens on addresses of interfaces only
constexpr int kPacketSize = 8996;                    // bytes, as through a network of jumbo frames
constexpr double kExposure_s = 20e-6;
constexpr std::chrono::seconds kWarmUp(1);
constexpr std::chrono::seconds kMeasured(4);

// Of this program, all threads.
double cpu_s() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// What came while it was counted.
struct Count {
  std::uint64_t good = 0;
  std::uint64_t damaged = 0;
  std::uint64_t lost = 0;  // exposed between good ones, and damaged or never seen

  // `id` counts from 1, and from there anew after kCycle where the client leaves it at that. Of damaged frames it may
  // be unknown.
  void add(std::uint64_t id, bool is_damaged) {
    constexpr std::uint64_t kCycle = 0xffff;
    ++(is_damaged ? damaged : good);
    if (is_damaged) return;
    if (last_ != 0) lost += (id > last_ ? id - last_ : id + kCycle - last_) - 1;
    last_ = id;
  }
  void clear() { good = damaged = lost = 0; }

 private:
  std::uint64_t last_ = 0;
};

// `take` takes one frame; what comes in the first second is not counted.
template <typename Take>
void measure(benchmark::State& state, std::size_t frame_bytes, Take take) {
  Count count;
  const auto run = [&](std::chrono::nanoseconds duration) {
    const HostTime end = HostClock::now() + duration;
    while (HostClock::now() < end) take(count);
  };
  run(kWarmUp);
  count.clear();
  const double cpu_before_s = cpu_s();
  const HostTime start = HostClock::now();
  for ([[maybe_unused]] const auto once : state) run(kMeasured);
  const double wall_s = std::chrono::duration<double>(HostClock::now() - start).count();
  const auto frames = static_cast<double>(count.good);
  state.counters["fps"] = frames / wall_s;
  state.counters["MB/s"] = frames * static_cast<double>(frame_bytes) / wall_s / 1e6;
  state.counters["CPU_%"] = 100 * (cpu_s() - cpu_before_s) / wall_s;
  state.counters["lost"] = static_cast<double>(count.lost);
  state.counters["damaged"] = static_cast<double>(count.damaged);
}

void take_by_us(benchmark::State& state, const char* address, cv::Size size, double fps_hz) {
  CameraRequest request;
  request.size = size;
  request.pixel_format = "Mono8";
  request.fps_hz = fps_hz;
  request.exposure_s = kExposure_s;
  request.packet_size = kPacketSize;
  const auto camera = open_genicam(address, request);
  measure(state, static_cast<std::size_t>(size.area()), [&](Count& count) {
    const auto frame = camera->wait(std::chrono::milliseconds(100));
    if (frame) count.add(frame->stamp.sequence.value_or(0), frame->stamp.is_damaged);
  });
}

template <typename T>
struct Unref {
  void operator()(T* object) const { g_object_unref(object); }
};

// kOptions: whether packets come through a packet socket, as Aravis has it for root, or an ordinary one, as for others
// and as we have it.
template <ArvGvStreamOption kOptions>
void take_by_aravis(benchmark::State& state, const char* address, cv::Size size, double fps_hz) {
  const std::unique_ptr<ArvCamera, Unref<ArvCamera>> camera(arv_camera_new(address, nullptr));
  if (!camera) return state.SkipWithError("no camera");
  arv_camera_set_region(camera.get(), 0, 0, size.width, size.height, nullptr);
  arv_camera_set_pixel_format_from_string(camera.get(), "Mono8", nullptr);
  arv_camera_set_frame_rate(camera.get(), fps_hz, nullptr);
  arv_camera_set_exposure_time(camera.get(), kExposure_s * 1e6, nullptr);
  arv_camera_gv_set_packet_size(camera.get(), kPacketSize, nullptr);
  arv_gv_device_set_stream_options(ARV_GV_DEVICE(arv_camera_get_device(camera.get())), kOptions);
  const std::unique_ptr<ArvStream, Unref<ArvStream>> stream(
      arv_camera_create_stream(camera.get(), nullptr, nullptr, nullptr));
  if (!stream) return state.SkipWithError("no stream");
  const guint payload = arv_camera_get_payload(camera.get(), nullptr);
  for (int i = 0; i < 50; ++i) arv_stream_push_buffer(stream.get(), arv_buffer_new(payload, nullptr));
  arv_camera_start_acquisition(camera.get(), nullptr);
  measure(state, payload, [&](Count& count) {
    ArvBuffer* const buffer = arv_stream_timeout_pop_buffer(stream.get(), 100'000);
    if (!buffer) return;
    count.add(arv_buffer_get_frame_id(buffer), arv_buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS);
    arv_stream_push_buffer(stream.get(), buffer);
  });
  arv_camera_stop_acquisition(camera.get(), nullptr);
}

// arv-fake-gv-camera, in a process of its own since its work is not ours.
class AravisCameraProcess {
 public:
  AravisCameraProcess() {
    const char* const arguments[] = {"arv-fake-gv-camera-0.8", "-i", kAravisAddress, "-s", "B1", nullptr};
    if (::posix_spawnp(&process_, arguments[0], nullptr, nullptr, const_cast<char**>(arguments), environ) != 0) {
      throw std::runtime_error("arv-fake-gv-camera-0.8 does not start; is aravis-tools installed?");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  ~AravisCameraProcess() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  AravisCameraProcess(const AravisCameraProcess&) = delete;
  AravisCameraProcess& operator=(const AravisCameraProcess&) = delete;

 private:
  pid_t process_ = -1;
};

using Client = void (*)(benchmark::State&, const char*, cv::Size, double);

void from_test_camera(benchmark::State& state, Client client, cv::Size size, const char* link) {
  const CameraProcess camera(ALIDADE_GIGE_TEST_CAMERA, {"--address", kOurAddress, "--link", link});
  constexpr double kMostFps = 100'000;
  client(state, kOurAddress, size, kMostFps);
}

void from_aravis_camera(benchmark::State& state, Client client, cv::Size size) {
  const AravisCameraProcess camera;
  constexpr double kMostFps = 1000;
  client(state, kAravisAddress, size, kMostFps);
}

void add(const std::string& name, Client client) {
  for (const cv::Size size : {cv::Size(512, 512), cv::Size(1280, 720), cv::Size(2048, 2048)}) {
    const std::string sized = std::to_string(size.width) + "x" + std::to_string(size.height) + "/" + name;
    const auto once = [](auto* benchmark) { benchmark->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime(); };
    once(benchmark::RegisterBenchmark(("test_camera/" + sized).c_str(), from_test_camera, client, size, "1000"));
    once(benchmark::RegisterBenchmark(("test_camera_unbounded/" + sized).c_str(), from_test_camera, client, size, "0"));
    once(benchmark::RegisterBenchmark(("aravis_camera/" + sized).c_str(), from_aravis_camera, client, size));
  }
}

}  // namespace
}  // namespace alidade::test

int main(int argc, char** argv) {
  alidade::test::add("ours", alidade::test::take_by_us);
  alidade::test::add("bare_aravis", alidade::test::take_by_aravis<ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED>);
  alidade::test::add("bare_aravis_as_root", alidade::test::take_by_aravis<ARV_GV_STREAM_OPTION_NONE>);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
