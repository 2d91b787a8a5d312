// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/recording/synthetic_camera.h"

#include <opencv2/core.hpp>
#include <turbojpeg.h>

namespace alidade::test {
namespace {

constexpr std::chrono::milliseconds kPeriod{40};
constexpr int kNoiseBits = 5;

// Values of `bits` bits: a ramp from left to right, and noise.
cv::Mat ramp(const PixelFormat& format, cv::Size size, std::uint64_t seed) {
  cv::Mat image(mat_size(format, size), mat_type(format));
  cv::RNG(seed).fill(image, cv::RNG::UNIFORM, 0, 1 << kNoiseBits);
  const int top = (1 << (format.bits > 8 ? format.bits : 8)) - (1 << kNoiseBits);
  for (int x = 0; x < image.cols; ++x) image.col(x) += cv::Scalar::all(static_cast<double>(top) * x / image.cols);
  return image;
}

// The ramp as a camera would pack it: 8 bits, grey.
cv::Mat jpeg_bytes(cv::Size size, std::uint64_t seed) {
  const cv::Mat image = ramp({}, size, seed);
  const tjhandle packer = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long length = 0;
  constexpr int kQuality = 80;
  const int failed = tjCompress2(packer, image.data, image.cols, static_cast<int>(image.step), image.rows, TJPF_GRAY,
                                 &bytes, &length, TJSAMP_GRAY, kQuality, 0);
  const cv::Mat packed = failed ? cv::Mat() : cv::Mat(1, static_cast<int>(length), CV_8UC1, bytes).clone();
  tjFree(bytes);
  tjDestroy(packer);
  return packed;
}

}  // namespace

std::vector<PixelFormat> all_pixel_formats() {
  std::vector<PixelFormat> formats{{PixelKind::Bgr}, {PixelKind::Yuyv}, {PixelKind::Nv12}, {PixelKind::Jpeg}};
  for (const int bits : {8, 10, 12, 14, 16}) formats.push_back({PixelKind::Grey, bits});
  formats.push_back({PixelKind::Bayer, 8, BayerPattern::GBRG});
  formats.push_back({PixelKind::Bayer, 12, BayerPattern::BGGR});
  return formats;
}

RecordingSubject synthetic_camera(const PixelFormat& format, cv::Size size) {
  RecordingSubject subject;
  subject.program = "alidade test";
  subject.camera.source = "synthetic:0";
  subject.camera.size = size;
  subject.camera.format = format;
  subject.camera.period = kPeriod;
  subject.camera.clock = "camera";
  return subject;
}

Frame synthetic_frame(const RecordingSubject& camera, int index) {
  const PixelFormat& format = camera.camera.format;
  const auto seed = static_cast<std::uint64_t>(index) + 1;
  Frame frame;
  frame.index = index;
  frame.time = Timestamp(std::chrono::seconds(1000) + kPeriod * index);
  frame.image =
      format.kind == PixelKind::Jpeg ? jpeg_bytes(camera.camera.size, seed) : ramp(format, camera.camera.size, seed);
  frame.format = format;
  frame.stamp.device_time = Timestamp(kPeriod * index);
  frame.stamp.host_time = HostTime(std::chrono::seconds(1000) + kPeriod * index + std::chrono::microseconds(index % 5));
  frame.stamp.sequence = static_cast<std::uint64_t>(index);
  return frame;
}

bool are_same(const Frame& a, const Frame& b) {
  const bool same_pixels = a.image.size() == b.image.size() && a.image.type() == b.image.type() &&
                           (a.image.empty() || cv::norm(a.image, b.image, cv::NORM_INF) == 0);
  return same_pixels && a.format == b.format && a.time == b.time && a.stamp.device_time == b.stamp.device_time &&
         a.stamp.host_time == b.stamp.host_time && a.stamp.sequence == b.stamp.sequence &&
         a.stamp.dropped_before == b.stamp.dropped_before && a.stamp.discarded_before == b.stamp.discarded_before &&
         a.stamp.is_damaged == b.stamp.is_damaged;
}

}  // namespace alidade::test
