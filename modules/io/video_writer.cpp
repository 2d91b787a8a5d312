// SPDX-License-Identifier: Apache-2.0
#include "io/video_writer.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <cmath>
#include <stdexcept>
#include <string>

#include <opencv2/core.hpp>

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/libav_error.h"

namespace alidade {
namespace {

struct FreeOutput {
  void operator()(AVFormatContext* p) const {
    avio_closep(&p->pb);
    avformat_free_context(p);
  }
};
struct FreeCodec {
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
};
struct FreeFrame {
  void operator()(AVFrame* p) const { av_frame_free(&p); }
};
struct FreePacket {
  void operator()(AVPacket* p) const { av_packet_free(&p); }
};
struct FreeScaler {
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};

const AVCodec* find_encoder(VideoKind kind) {
  if (kind == VideoKind::Lossless) return avcodec_find_encoder(AV_CODEC_ID_FFV1);
  const AVCodec* x264 = avcodec_find_encoder_by_name("libx264");
  return x264 ? x264 : avcodec_find_encoder(AV_CODEC_ID_MPEG4);
}

int even(int size) {
  return size + size % 2;
}

}  // namespace

struct VideoWriter::State {
  std::filesystem::path path;
  cv::Size size;
  VideoOptions options;
  std::unique_ptr<AVFormatContext, FreeOutput> output;
  std::unique_ptr<AVCodecContext, FreeCodec> encoder;
  std::unique_ptr<AVFrame, FreeFrame> frame{av_frame_alloc()};
  std::unique_ptr<AVPacket, FreePacket> packet{av_packet_alloc()};
  std::unique_ptr<SwsContext, FreeScaler> scaler;
  AVStream* stream = nullptr;
  int image_type = -1;  // of the first frame
  std::int64_t next_index = 0;
  bool closed = false;

  ~State();
  void open_encoder(AVPixelFormat format);
  void open_file();
  void start(int type);
  void fill_frame(const cv::Mat& image);
  void encode(const AVFrame* image);
  void check(int result, const char* operation);
  bool is_movie() const { return options.kind == VideoKind::Movie; }
};

VideoWriter::State::~State() {
  const bool useless = !closed && (is_movie() || next_index == 0);
  output.reset();
  std::error_code ignored;
  if (useless) std::filesystem::remove(part_name(path), ignored);
}

void VideoWriter::State::check(int result, const char* operation) {
  if (result >= 0) return;
  const std::string remedy = result == AVERROR(ENOSPC) ? "free some space and run it again" : "";
  throw DeviceError(path, operation, libav_message(result), remedy);
}

void VideoWriter::State::open_encoder(AVPixelFormat format) {
  const AVCodec* codec = find_encoder(options.kind);
  if (!codec) throw DeviceError(path, "cannot be created", "libav has no encoder for it", "install libavcodec-extra");
  encoder.reset(avcodec_alloc_context3(codec));
  encoder->width = is_movie() ? even(size.width) : size.width;
  encoder->height = is_movie() ? even(size.height) : size.height;
  encoder->pix_fmt = format;
  encoder->framerate = av_d2q(options.fps_hz, 100'000);
  encoder->time_base = av_inv_q(encoder->framerate);
  if (is_movie()) {
    encoder->colorspace = AVCOL_SPC_BT709;
    encoder->color_range = AVCOL_RANGE_MPEG;
    if (codec->id == AV_CODEC_ID_H264) {
      av_opt_set(encoder->priv_data, "preset", "veryfast", 0);
      av_opt_set_int(encoder->priv_data, "crf", options.rate_factor, 0);
      av_opt_set_int(encoder->priv_data, "mbtree", 0, 0);  // Debian's x264 gives other bytes from run to run with it
    } else {
      encoder->flags |= AV_CODEC_FLAG_QSCALE;
      encoder->global_quality = FF_QP2LAMBDA * std::max(1, options.rate_factor / 6);
    }
  } else {
    encoder->level = 3;
    encoder->gop_size = 1;
    encoder->slices = 4;
    encoder->thread_count = 2;
    av_opt_set_int(encoder->priv_data, "slicecrc", 1, 0);
  }
  if (output->oformat->flags & AVFMT_GLOBALHEADER) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  check(avcodec_open2(encoder.get(), codec, nullptr), "cannot be encoded");
}

void VideoWriter::State::open_file() {
  check(avio_open(&output->pb, output->url, AVIO_FLAG_WRITE), "cannot be created");
  output->flags |= AVFMT_FLAG_BITEXACT;  // no random numbers and no dates in the file
  if (!is_movie()) output->flags |= AVFMT_FLAG_FLUSH_PACKETS;
}

// The pixel format of a lossless video follows the first frame, so the header waits for it.
void VideoWriter::State::start(int type) {
  image_type = type;
  const AVPixelFormat lossless = type == CV_8UC1 ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_BGR0;
  open_encoder(is_movie() ? AV_PIX_FMT_YUV420P : lossless);
  stream = avformat_new_stream(output.get(), nullptr);
  stream->time_base = encoder->time_base;
  stream->avg_frame_rate = encoder->framerate;
  check(avcodec_parameters_from_context(stream->codecpar, encoder.get()), "cannot be encoded");
  if (is_movie()) {
    av_opt_set(output->priv_data, "movflags", "+faststart", 0);
  } else {
    av_opt_set_int(output->priv_data, "cluster_time_limit", 100, 0);  // ms: what a crash may cost
  }
  check(avformat_write_header(output.get(), nullptr), "cannot be written");
  frame->format = encoder->pix_fmt;
  frame->width = encoder->width;
  frame->height = encoder->height;
  check(av_frame_get_buffer(frame.get(), 0), "cannot be encoded");
}

void VideoWriter::State::fill_frame(const cv::Mat& image) {
  check(av_frame_make_writable(frame.get()), "cannot be encoded");
  if (frame->format == AV_PIX_FMT_GRAY8) {  // swscale would stretch the range of the values
    const auto step = static_cast<std::size_t>(frame->linesize[0]);
    image.copyTo(cv::Mat(frame->height, frame->width, CV_8UC1, frame->data[0], step));
    return;
  }
  cv::Mat padded = image;
  if (image.cols != frame->width || image.rows != frame->height) {
    cv::copyMakeBorder(image, padded, 0, frame->height - image.rows, 0, frame->width - image.cols,
                       cv::BORDER_REPLICATE);
  }
  if (!scaler) {
    const AVPixelFormat from = image.type() == CV_8UC1 ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_BGR24;
    // SWS_POINT alone only moves the bytes of a lossless frame; other flags take them through YUV.
    const int flags = is_movie() ? SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT : SWS_POINT;
    scaler.reset(sws_getContext(frame->width, frame->height, from, frame->width, frame->height,
                                static_cast<AVPixelFormat>(frame->format), flags, nullptr, nullptr, nullptr));
    sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(SWS_CS_DEFAULT), 1, sws_getCoefficients(SWS_CS_ITU709),
                             is_movie() ? 0 : 1, 0, 1 << 16, 1 << 16);
  }
  const std::uint8_t* const rows[4] = {padded.data};
  const int steps[4] = {static_cast<int>(padded.step)};
  sws_scale(scaler.get(), rows, steps, 0, frame->height, frame->data, frame->linesize);
}

void VideoWriter::State::encode(const AVFrame* image) {
  check(avcodec_send_frame(encoder.get(), image), "cannot be encoded");
  while (true) {
    const int result = avcodec_receive_packet(encoder.get(), packet.get());
    if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
    check(result, "cannot be encoded");
    packet->duration = 1;
    av_packet_rescale_ts(packet.get(), encoder->time_base, stream->time_base);
    packet->stream_index = stream->index;
    check(av_interleaved_write_frame(output.get(), packet.get()), "cannot be written");
  }
}

VideoWriter::VideoWriter(const std::filesystem::path& path, cv::Size size, const VideoOptions& options)
    : state_(std::make_unique<State>()) {
  if (size.width <= 0 || size.height <= 0) throw std::invalid_argument("VideoWriter: the size must be > 0 px");
  if (!(options.fps_hz > 0) || !std::isfinite(options.fps_hz)) {
    throw std::invalid_argument("VideoWriter: fps_hz must be > 0");
  }
  av_log_set_level(AV_LOG_QUIET);  // faults are told by exceptions, not by libav on stderr
  state_->path = path;
  state_->size = size;
  state_->options = options;
  AVFormatContext* context = nullptr;
  const std::string url = "file:" + part_name(path).string();
  const char* const format = options.kind == VideoKind::Movie ? "mp4" : "matroska";
  const int result = avformat_alloc_output_context2(&context, nullptr, format, url.c_str());
  state_->output.reset(context);
  state_->check(result, "cannot be created");
  state_->open_file();
}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

void VideoWriter::write(const cv::Mat& image) {
  State& s = *state_;
  const bool type_fits = image.type() == CV_8UC1 || image.type() == CV_8UC3;
  if (s.closed) throw std::invalid_argument("VideoWriter::write after close");
  if (!type_fits || image.size() != s.size) throw std::invalid_argument("VideoWriter::write: another size or type");
  if (s.image_type < 0) s.start(image.type());
  if (image.type() != s.image_type) throw std::invalid_argument("VideoWriter::write: grey and colour in one video");
  s.fill_frame(image);
  s.frame->pts = s.next_index++;
  s.encode(s.frame.get());
}

void VideoWriter::close() {
  State& s = *state_;
  if (s.closed) throw std::invalid_argument("VideoWriter::close twice");
  if (s.image_type < 0) throw std::invalid_argument("VideoWriter::close: a video needs a frame");
  s.encode(nullptr);
  s.check(av_write_trailer(s.output.get()), "cannot be written");
  s.check(avio_closep(&s.output->pb), "cannot be closed");
  commit_part(s.path);
  s.closed = true;
}

}  // namespace alidade
