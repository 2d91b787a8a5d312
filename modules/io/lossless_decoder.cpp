// SPDX-License-Identifier: Apache-2.0
#include "io/lossless_decoder.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

#include <algorithm>
#include <new>
#include <thread>

#include "io/libav_handles.h"
#include "io/lossless_planes.h"

namespace alidade {
namespace {

// As many as there are slices, or processors. The bytes do not depend on it.
int thread_count() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 4);
}
constexpr std::size_t kBitmapHeader = 40;  // bytes, before what ffvhuff must know

}  // namespace

struct LosslessDecoder::State {
  LosslessFormat format;
  LibavHandle<AVCodecContext> decoder;  // none for raw
  LibavHandle<AVFrame> frame{av_frame_alloc()};
  LibavHandle<AVPacket> packet{av_packet_alloc()};

  void open(std::string_view codec_private);
  std::optional<cv::Mat> decode(std::string_view bytes);
};

void LosslessDecoder::State::open(std::string_view codec_private) {
  av_log_set_level(AV_LOG_QUIET);
  const AVCodec* codec =
      avcodec_find_decoder(format.codec == LosslessCodec::Ffv1 ? AV_CODEC_ID_FFV1 : AV_CODEC_ID_FFVHUFF);
  decoder.reset(avcodec_alloc_context3(codec));
  decoder->width = format.size.width;
  decoder->height = format.size.height;
  decoder->thread_type = FF_THREAD_SLICE;
  decoder->thread_count = thread_count();
  decoder->err_recognition = AV_EF_CRCCHECK | AV_EF_EXPLODE;
  if (format.codec == LosslessCodec::FfvHuff && codec_private.size() >= kBitmapHeader) {
    decoder->codec_tag = MKTAG('F', 'F', 'V', 'H');
    decoder->bits_per_coded_sample = static_cast<unsigned char>(codec_private[14]);
    codec_private.remove_prefix(kBitmapHeader);
  }
  decoder->extradata = static_cast<std::uint8_t*>(av_mallocz(codec_private.size() + AV_INPUT_BUFFER_PADDING_SIZE));
  decoder->extradata_size = static_cast<int>(codec_private.size());
  std::copy(codec_private.begin(), codec_private.end(), decoder->extradata);
  if (avcodec_open2(decoder.get(), codec, nullptr) < 0) decoder.reset();
}

std::optional<cv::Mat> LosslessDecoder::State::decode(std::string_view bytes) {
  if (!decoder || bytes.empty()) return std::nullopt;
  av_packet_unref(packet.get());
  if (av_new_packet(packet.get(), static_cast<int>(bytes.size())) < 0) throw std::bad_alloc();
  std::copy(bytes.begin(), bytes.end(), packet->data);
  if (avcodec_send_packet(decoder.get(), packet.get()) < 0) return std::nullopt;
  if (avcodec_receive_frame(decoder.get(), frame.get()) < 0) return std::nullopt;
  if (!is_from_planes(frame->format, format.layout) || frame->width != format.size.width ||
      frame->height != format.size.height)
    return std::nullopt;
  return from_planes(*frame, format.layout);
}

LosslessDecoder::LosslessDecoder(const LosslessFormat& format, std::string_view codec_private)
    : state_(std::make_unique<State>()) {
  validate(format);
  state_->format = format;
  if (format.codec != LosslessCodec::Raw) state_->open(codec_private);
}
LosslessDecoder::~LosslessDecoder() = default;
LosslessDecoder::LosslessDecoder(LosslessDecoder&&) noexcept = default;
LosslessDecoder& LosslessDecoder::operator=(LosslessDecoder&&) noexcept = default;

std::optional<cv::Mat> LosslessDecoder::decode(std::string_view packet) {
  const LosslessFormat& format = state_->format;
  if (format.codec != LosslessCodec::Raw) return state_->decode(packet);
  const bool is_jpeg = format.layout == PixelLayout::Jpeg;
  cv::Mat image = is_jpeg ? cv::Mat(1, static_cast<int>(packet.size()), CV_8UC1)
                          : cv::Mat(mat_size(format.layout, format.size), mat_type(format.layout));
  if (packet.empty() || packet.size() != image.total() * image.elemSize()) return std::nullopt;
  std::copy(packet.begin(), packet.end(), reinterpret_cast<char*>(image.data));
  return image;
}

}  // namespace alidade
