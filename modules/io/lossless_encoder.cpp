// SPDX-License-Identifier: Apache-2.0
#include "io/lossless_encoder.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
}

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/errors.h"
#include "io/ebml.h"
#include "io/libav_error.h"
#include "io/libav_handles.h"
#include "io/lossless_planes.h"

namespace alidade {
namespace {

// As many as there are slices, or processors. The bytes do not depend on it.
int thread_count() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 4);
}

void check(int result) {
  if (result < 0) throw DeviceError("video", "cannot be encoded", libav_message(result), "");
}

// Rows without what may lie between them.
std::string_view bytes_of(const cv::Mat& image, std::string& copy) {
  const std::size_t row = image.cols * image.elemSize();
  if (image.isContinuous()) return {reinterpret_cast<const char*>(image.data), row * image.rows};
  copy.clear();
  for (int y = 0; y < image.rows; ++y) copy.append(reinterpret_cast<const char*>(image.ptr(y)), row);
  return copy;
}

// Microsoft's BITMAPINFOHEADER, by which Matroska names codecs that it has no name for.
std::string bitmap_header(const AVCodecContext& encoder) {
  const auto number = [](std::uint64_t value, int count) {
    const std::string bytes = big_endian(value, count);
    return std::string(bytes.rbegin(), bytes.rend());
  };
  const auto extra = static_cast<std::size_t>(encoder.extradata_size);
  return number(40 + extra, 4) + number(static_cast<std::uint64_t>(encoder.width), 4) +
         number(static_cast<std::uint64_t>(encoder.height), 4) + number(1, 2) +
         number(static_cast<std::uint64_t>(encoder.bits_per_coded_sample), 2) + "FFVH" + number(0, 4) + number(0, 4) +
         number(0, 4) + number(0, 4) + number(0, 4);
}

}  // namespace

struct LosslessEncoder::State {
  LosslessFormat format;
  LibavHandle<AVCodecContext> encoder;  // none for raw
  LibavHandle<AVFrame> frame{av_frame_alloc()};
  LibavHandle<AVPacket> packet{av_packet_alloc()};
  std::string rows;
  std::int64_t next_index = 0;

  void open();
  std::string_view encode(const cv::Mat& image);
};

void LosslessEncoder::State::open() {
  av_log_set_level(AV_LOG_QUIET);  // faults are told by exceptions, not by libav on stderr
  const AVCodec* codec =
      avcodec_find_encoder(format.codec == LosslessCodec::Ffv1 ? AV_CODEC_ID_FFV1 : AV_CODEC_ID_FFVHUFF);
  if (!codec) throw DeviceError("video", "cannot be created", "libav has no encoder for it", "install libavcodec59");
  encoder.reset(avcodec_alloc_context3(codec));
  encoder->width = format.size.width;
  encoder->height = format.size.height;
  encoder->pix_fmt = static_cast<AVPixelFormat>(libav_format(format.layout, format.codec));
  encoder->time_base = {1, 1'000'000};
  encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  encoder->thread_type = FF_THREAD_SLICE;  // frame threads would keep frames back
  encoder->thread_count = format.codec == LosslessCodec::Ffv1 ? thread_count() : 1;
  if (format.codec == LosslessCodec::Ffv1) {
    encoder->level = 3;
    encoder->gop_size = 1;
    encoder->slices = 4;
    av_opt_set_int(encoder->priv_data, "slicecrc", 1, 0);
  }
  check(avcodec_open2(encoder.get(), codec, nullptr));
  frame->format = encoder->pix_fmt;
  frame->width = encoder->width;
  frame->height = encoder->height;
  check(av_frame_get_buffer(frame.get(), 0));
}

std::string_view LosslessEncoder::State::encode(const cv::Mat& image) {
  check(av_frame_make_writable(frame.get()));
  to_planes(image, format.layout, *frame);
  frame->pts = next_index++;
  check(avcodec_send_frame(encoder.get(), frame.get()));
  av_packet_unref(packet.get());
  check(avcodec_receive_packet(encoder.get(), packet.get()));
  return {reinterpret_cast<const char*>(packet->data), static_cast<std::size_t>(packet->size)};
}

LosslessEncoder::LosslessEncoder(const LosslessFormat& format) : state_(std::make_unique<State>()) {
  validate(format);
  state_->format = format;
  if (format.codec != LosslessCodec::Raw) state_->open();
}
LosslessEncoder::~LosslessEncoder() = default;
LosslessEncoder::LosslessEncoder(LosslessEncoder&&) noexcept = default;
LosslessEncoder& LosslessEncoder::operator=(LosslessEncoder&&) noexcept = default;

std::string_view LosslessEncoder::encode(const cv::Mat& image) {
  State& s = *state_;
  const PixelLayout layout = s.format.layout;
  const bool fits = layout == PixelLayout::Jpeg
                        ? image.type() == CV_8UC1 && image.rows == 1
                        : image.type() == mat_type(layout) && image.size() == mat_size(layout, s.format.size);
  if (!fits) throw std::invalid_argument("LosslessEncoder::encode: another size or type");
  return s.encoder ? s.encode(image) : bytes_of(image, s.rows);
}

MatroskaTrack LosslessEncoder::track(std::optional<std::chrono::nanoseconds> period) const {
  const auto& [format, encoder, frame, packet, rows, next_index] = *state_;
  if (format.layout == PixelLayout::Jpeg) return {"V_MJPEG", "", 0, format.size, period};
  if (!encoder) {
    const auto pixels = static_cast<AVPixelFormat>(libav_format(format.layout, format.codec));
    return {"V_UNCOMPRESSED", "", avcodec_pix_fmt_to_codec_tag(pixels), format.size, period};
  }
  const std::string extra(reinterpret_cast<const char*>(encoder->extradata),
                          static_cast<std::size_t>(encoder->extradata_size));
  if (format.codec == LosslessCodec::Ffv1) return {"V_FFV1", extra, 0, format.size, period};
  return {"V_MS/VFW/FOURCC", bitmap_header(*encoder) + extra, 0, format.size, period};
}

}  // namespace alidade
