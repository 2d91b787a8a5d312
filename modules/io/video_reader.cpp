// SPDX-License-Identifier: Apache-2.0
#include "io/video_reader.h"

#include <fmt/format.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/crc.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/errors.h"
#include "io/libav_error.h"
#include "io/libav_handles.h"

namespace alidade {
namespace {

struct CloseInput {
  void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
};

std::optional<double> positive(AVRational rate) {
  if (rate.num <= 0 || rate.den <= 0) return std::nullopt;
  return av_q2d(rate);
}

bool is_grey(const AVFrame& frame) {
  return frame.format == AV_PIX_FMT_GRAY8;
}

// Chroma is interpolated and rounding is exact, so that the pixels do not depend on the processor.
LibavHandle<SwsContext> make_scaler(const AVFrame& frame) {
  const AVPixFmtDescriptor* format = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  const bool rgb = (format->flags & AV_PIX_FMT_FLAG_RGB) != 0;
  // SWS_POINT alone reorders the bytes of RGB; with the other flags swscale goes by way of YUV and loses digits.
  const int flags = rgb ? SWS_POINT : SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT;
  SwsContext* scaler = sws_getContext(frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width,
                                      frame.height, AV_PIX_FMT_BGR24, flags, nullptr, nullptr, nullptr);
  if (!scaler || rgb) return LibavHandle<SwsContext>(scaler);
  const int space = frame.colorspace == AVCOL_SPC_UNSPECIFIED ? SWS_CS_DEFAULT : static_cast<int>(frame.colorspace);
  const int full_range = frame.color_range == AVCOL_RANGE_JPEG ? 1 : 0;
  sws_setColorspaceDetails(scaler, sws_getCoefficients(space), full_range, sws_getCoefficients(SWS_CS_DEFAULT), 1, 0,
                           1 << 16, 1 << 16);
  return LibavHandle<SwsContext>(scaler);
}

// Whether every slice of an FFV1 frame has its checksum; libav's decoder paints over a slice that has not, in silence.
// Slices follow each other, each with its size (3 bytes), a status byte and a CRC-32 that makes the whole come to 0.
// Source: RFC 9043, 4.9 (slice footer). False as well for a video that was written without checksums.
bool has_checksums(const AVPacket& packet) {
  constexpr int kFooter = 8;
  const AVCRC* const table = av_crc_get_table(AV_CRC_32_IEEE);
  int end = packet.size;
  while (end > kFooter) {
    const std::uint8_t* const size = packet.data + end - kFooter;
    const int length = (size[0] << 16 | size[1] << 8 | size[2]) + kFooter;
    if (length > end || av_crc(table, 0, packet.data + end - length, static_cast<std::size_t>(length)) != 0)
      return false;
    end -= length;
  }
  return end == 0;
}

}  // namespace

struct VideoReader::State {
  std::filesystem::path path;
  VideoFacts facts;
  std::unique_ptr<AVFormatContext, CloseInput> input;
  LibavHandle<AVCodecContext> decoder;
  LibavHandle<AVFrame> frame{av_frame_alloc()};
  LibavHandle<AVPacket> packet{av_packet_alloc()};
  LibavHandle<SwsContext> scaler;
  int scaler_format = -1;
  AVStream* stream = nullptr;
  double end_s = 0;  // of the last packet
  int frames_read = 0;
  int frames_damaged = 0;  // packets or frames that the decoder refused or had to guess at
  int frames_missing = 0;  // gaps between frames: a damaged container passes over what it cannot read in silence
  std::optional<std::int64_t> previous_end;  // of the last good frame, in the stream's units
  bool checksums = false;                    // a frame with checksums was seen, so all must have them
  bool finished = false;

  void open();
  void feed();
  void note_gap();
  bool is_whole(const AVPacket& read);
  void note_end(const AVPacket& read);
  std::optional<VideoFrame> convert();
  std::optional<std::string> find_fault() const;
  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputError(path, 0, "is no readable video: " + reason, "convert it to MP4 or MKV, or record it again");
  }
};

void VideoReader::State::open() {
  av_log_set_level(AV_LOG_QUIET);  // faults are told by fault() and by exceptions, not by libav on stderr
  AVFormatContext* context = nullptr;
  const std::string url = "file:" + path.string();
  if (const int error = avformat_open_input(&context, url.c_str(), nullptr, nullptr)) refuse(libav_message(error));
  input.reset(context);
  if (const int error = avformat_find_stream_info(context, nullptr); error < 0) refuse(libav_message(error));
  const AVCodec* codec = nullptr;
  const int index = av_find_best_stream(context, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
  if (index < 0 || !codec) refuse("it holds no video stream that can be decoded");
  stream = context->streams[index];
  decoder.reset(avcodec_alloc_context3(codec));
  avcodec_parameters_to_context(decoder.get(), stream->codecpar);
  decoder->pkt_timebase = stream->time_base;
  decoder->thread_count = 2;
  decoder->thread_type = FF_THREAD_SLICE;  // with frame threads, what becomes of a damaged stream depends on timing
  if (const int error = avcodec_open2(decoder.get(), codec, nullptr)) refuse(libav_message(error));
  facts = {stream->codecpar->width, stream->codecpar->height, avcodec_get_name(codec->id),
           positive(stream->avg_frame_rate), std::nullopt};
  if (stream->nb_frames > 0) facts.frame_count = static_cast<int>(stream->nb_frames);
  if (facts.width <= 0 || facts.height <= 0) refuse("it says no frame size");
}

void VideoReader::State::note_end(const AVPacket& read) {
  const std::int64_t time = read.pts != AV_NOPTS_VALUE ? read.pts : read.dts;
  if (time == AV_NOPTS_VALUE) return;
  end_s = std::max(end_s, static_cast<double>(time + read.duration) * av_q2d(stream->time_base));
}

void VideoReader::State::note_gap() {
  const std::int64_t start = frame->best_effort_timestamp, duration = frame->pkt_duration;
  if (start == AV_NOPTS_VALUE || duration <= 0) return previous_end.reset();
  if (previous_end && start > *previous_end) {
    frames_missing += static_cast<int>(std::lround(static_cast<double>(start - *previous_end) / duration));
  }
  previous_end = start + duration;
}

bool VideoReader::State::is_whole(const AVPacket& read) {
  if (decoder->codec_id != AV_CODEC_ID_FFV1) return true;
  const bool checked = has_checksums(read);
  checksums = checksums || checked;
  return checked || !checksums;
}

// Gives the decoder the next packet, or the end.
void VideoReader::State::feed() {
  while (true) {
    const int error = av_read_frame(input.get(), packet.get());
    if (error < 0) {
      if (error != AVERROR_EOF) ++frames_damaged;
      avcodec_send_packet(decoder.get(), nullptr);
      return;
    }
    const bool ours = packet->stream_index == stream->index;
    if (ours) note_end(*packet);
    int refused = ours && !is_whole(*packet) ? AVERROR_INVALIDDATA : 0;
    if (ours && refused == 0) refused = avcodec_send_packet(decoder.get(), packet.get());
    av_packet_unref(packet.get());
    if (refused < 0) ++frames_damaged;
    if (ours && refused >= 0) return;
  }
}

std::optional<VideoFrame> VideoReader::State::convert() {
  if (frame->decode_error_flags != 0 || (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0) {
    ++frames_damaged;
    return std::nullopt;
  }
  if (frame->width != facts.width || frame->height != facts.height) {
    throw InputError(path, 0,
                     fmt::format("frame {} is {}x{} px, the ones before are {}x{} px", frames_read, frame->width,
                                 frame->height, facts.width, facts.height),
                     "all frames must come from one camera");
  }
  note_gap();
  VideoFrame result;
  if (is_grey(*frame)) {
    cv::Mat(frame->height, frame->width, CV_8UC1, frame->data[0], static_cast<std::size_t>(frame->linesize[0]))
        .copyTo(result.image);
  } else {
    if (frame->format != scaler_format) scaler = make_scaler(*frame);
    scaler_format = frame->format;
    if (!scaler) refuse("its pixel format is not supported");
    result.image.create(frame->height, frame->width, CV_8UC3);
    std::uint8_t* const rows[4] = {result.image.data};
    const int steps[4] = {static_cast<int>(result.image.step)};
    sws_scale(scaler.get(), frame->data, frame->linesize, 0, frame->height, rows, steps);
  }
  if (const std::int64_t time = frame->best_effort_timestamp; time != AV_NOPTS_VALUE) {
    result.time = Timestamp(std::chrono::nanoseconds(av_rescale_q(time, stream->time_base, {1, 1'000'000'000})));
  }
  ++frames_read;
  return result;
}

std::optional<std::string> VideoReader::State::find_fault() const {
  const bool says_duration = input->duration > 0 && input->duration_estimation_method != AVFMT_DURATION_FROM_BITRATE;
  const double duration_s = says_duration ? static_cast<double>(input->duration) / AV_TIME_BASE : 0;
  const double start_s =
      input->start_time == AV_NOPTS_VALUE ? 0 : static_cast<double>(input->start_time) / AV_TIME_BASE;
  const double period_s = 1.0 / facts.fps_hz.value_or(10.0);
  if (says_duration && end_s - start_s < duration_s - 1.5 * period_s) {
    return fmt::format("{}: ends after {:.3f} s of {:.3f} s, {} frames can be read; the file is cut off or damaged",
                       path.string(), std::max(0.0, end_s - start_s), duration_s, frames_read);
  }
  if (const int lost = std::max(frames_damaged, frames_missing); lost > 0) {
    return fmt::format("{}: {} frames are damaged or missing, {} can be read", path.string(), lost, frames_read);
  }
  if (frames_read == 0) return fmt::format("{}: holds no frame that can be read", path.string());
  if (!says_duration && std::string_view(input->iformat->name).starts_with("matroska")) {
    return fmt::format("{}: was not closed when it was recorded, {} frames can be read", path.string(), frames_read);
  }
  return std::nullopt;
}

VideoReader::VideoReader(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
  state_->path = path;
  state_->open();
}
VideoReader::~VideoReader() = default;
VideoReader::VideoReader(VideoReader&&) noexcept = default;
VideoReader& VideoReader::operator=(VideoReader&&) noexcept = default;

const VideoFacts& VideoReader::facts() const {
  return state_->facts;
}

std::optional<VideoFrame> VideoReader::next() {
  State& s = *state_;
  while (!s.finished) {
    const int result = avcodec_receive_frame(s.decoder.get(), s.frame.get());
    if (result == 0) {
      if (auto frame = s.convert()) return frame;
    } else if (result == AVERROR(EAGAIN)) {
      s.feed();
    } else if (result == AVERROR_EOF) {
      s.finished = true;
    } else {
      ++s.frames_damaged;
    }
  }
  return std::nullopt;
}

std::optional<std::string> VideoReader::fault() const {
  return state_->finished ? state_->find_fault() : std::nullopt;
}

}  // namespace alidade
