// SPDX-License-Identifier: Apache-2.0
#include "capture/decoding.h"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <turbojpeg.h>

namespace alidade {
namespace {

struct FreeDecompressor {
  void operator()(void* handle) const { tjDestroy(handle); }
};

cv::Mat decode_jpeg(const cv::Mat& bytes) {
  const std::unique_ptr<void, FreeDecompressor> jpeg(tjInitDecompress());
  const auto size = static_cast<unsigned long>(bytes.total());
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (tjDecompressHeader3(jpeg.get(), bytes.data, size, &width, &height, &subsampling, &colours) != 0) return {};
  const bool is_grey = subsampling == TJSAMP_GRAY;
  cv::Mat image(height, width, is_grey ? CV_8UC1 : CV_8UC3);
  // A mere warning of the decoder means bytes that are missing or wrong, painted over.
  const int result = tjDecompress2(jpeg.get(), bytes.data, size, image.data, width, static_cast<int>(image.step),
                                   height, is_grey ? TJPF_GRAY : TJPF_BGR, 0);
  return result == 0 ? image : cv::Mat();
}

int bayer_conversion(BayerPattern pattern) {
  switch (pattern) {
    case BayerPattern::RGGB:
      return cv::COLOR_BayerRGGB2BGR;
    case BayerPattern::GRBG:
      return cv::COLOR_BayerGRBG2BGR;
    case BayerPattern::GBRG:
      return cv::COLOR_BayerGBRG2BGR;
    case BayerPattern::BGGR:
      return cv::COLOR_BayerBGGR2BGR;
  }
  throw std::invalid_argument("decode: unknown Bayer pattern");
}

// The upper eight of the image's bits.
cv::Mat to_eight_bits(const cv::Mat& image, int bits) {
  if (bits == 8) return image;
  cv::Mat eight;
  const double step = 1 << (bits - 8);
  image.convertTo(eight, CV_8U, 1 / step, -0.5 + 0.5 / step);  // convertTo rounds; so this cuts
  return eight;
}

cv::Mat converted(const cv::Mat& image, int conversion) {
  cv::Mat bgr;
  cv::cvtColor(image, bgr, conversion);
  return bgr;
}

class Decoded : public FrameSource {
 public:
  explicit Decoded(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  std::optional<Frame> next(std::stop_token stop) override {
    std::uint64_t dropped = 0, discarded = 0;
    while (auto frame = source_->next(stop)) {
      CaptureStamp& stamp = frame->stamp;
      cv::Mat image = stamp.is_damaged ? cv::Mat() : decode(frame->image, frame->format);
      if (image.empty()) {
        ++damaged_;
        dropped += 1 + stamp.dropped_before;
        discarded += stamp.discarded_before;
        continue;
      }
      stamp.dropped_before += dropped;
      stamp.discarded_before += discarded;
      frame->image = std::move(image);
      frame->format = {frame->image.channels() == 1 ? PixelKind::Grey : PixelKind::Bgr};
      return frame;
    }
    return std::nullopt;
  }

  std::optional<int> frame_count() const override { return source_->frame_count(); }
  bool has_times() const override { return source_->has_times(); }
  std::string describe() const override { return source_->describe(); }

  std::optional<std::string> fault() const override {
    const auto fault = source_->fault();
    if (damaged_ == 0) return fault;
    const std::string left_out = fmt::format("{} damaged frame{} left out", damaged_, damaged_ == 1 ? "" : "s");
    return fault ? *fault + "; " + left_out : left_out;
  }

 private:
  std::unique_ptr<FrameSource> source_;
  std::uint64_t damaged_ = 0;
};

}  // namespace

cv::Mat decode(const cv::Mat& image, const PixelFormat& format) {
  if (image.empty()) return {};
  switch (format.kind) {
    case PixelKind::Grey:
      return to_eight_bits(image, format.bits);
    case PixelKind::Bayer:
      return converted(to_eight_bits(image, format.bits), bayer_conversion(format.pattern));
    case PixelKind::Bgr:
      return image;
    case PixelKind::Yuyv:
      return converted(image, cv::COLOR_YUV2BGR_YUYV);
    case PixelKind::Nv12:
      return converted(image, cv::COLOR_YUV2BGR_NV12);
    case PixelKind::Jpeg:
      return decode_jpeg(image);
  }
  throw std::invalid_argument("decode: unknown pixel format");
}

std::unique_ptr<FrameSource> decoded(std::unique_ptr<FrameSource> source) {
  if (!source) throw std::invalid_argument("decoded: a source is needed");
  return std::make_unique<Decoded>(std::move(source));
}

}  // namespace alidade
