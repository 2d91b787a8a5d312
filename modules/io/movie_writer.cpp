// SPDX-License-Identifier: Apache-2.0
#include "io/movie_writer.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <string>

#include <opencv2/core.hpp>

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/libav_error.h"
#include "io/libav_handles.h"

namespace alidade {
namespace {

struct FreeOutput {
  void operator()(AVFormatContext* p) const {
    avio_closep(&p->pb);
    avformat_free_context(p);
  }
};
const AVCodec* find_encoder() {
  const AVCodec* x264 = avcodec_find_encoder_by_name("libx264");
  return x264 ? x264 : avcodec_find_encoder(AV_CODEC_ID_MPEG4);
}

int even(int size) {
  return size + size % 2;
}

}  // namespace

struct MovieWriter::State {
  std::filesystem::path path;
  cv::Size size;
  double fps_hz = 0;
  int rate_factor = 0;
  std::unique_ptr<AVFormatContext, FreeOutput> output;
  LibavHandle<AVCodecContext> encoder;
  LibavHandle<AVFrame> frame{av_frame_alloc()};
  LibavHandle<AVPacket> packet{av_packet_alloc()};
  LibavHandle<SwsContext> scaler;
  AVStream* stream = nullptr;
  std::int64_t next_index = 0;
  bool closed = false;

  ~State();
  void open_encoder();
  void open_file();
  void start();
  void fill_frame(const cv::Mat& image);
  void encode(const AVFrame* image);
  void check(int result, const char* operation);
};

MovieWriter::State::~State() {
  output.reset();
  std::error_code ignored;
  if (!closed) std::filesystem::remove(part_name(path), ignored);
}

void MovieWriter::State::check(int result, const char* operation) {
  if (result >= 0) return;
  const std::string remedy = result == AVERROR(ENOSPC) ? "free some space and run it again" : "";
  throw DeviceError(path, operation, libav_message(result), remedy);
}

void MovieWriter::State::open_encoder() {
  const AVCodec* codec = find_encoder();
  if (!codec) throw DeviceError(path, "cannot be created", "libav has no encoder for it", "install libavcodec-extra");
  encoder.reset(avcodec_alloc_context3(codec));
  encoder->width = even(size.width);
  encoder->height = even(size.height);
  encoder->pix_fmt = AV_PIX_FMT_YUV420P;
  encoder->framerate = av_d2q(fps_hz, 100'000);
  encoder->time_base = av_inv_q(encoder->framerate);
  encoder->colorspace = AVCOL_SPC_BT709;
  encoder->color_range = AVCOL_RANGE_MPEG;
  if (codec->id == AV_CODEC_ID_H264) {
    av_opt_set(encoder->priv_data, "preset", "veryfast", 0);
    av_opt_set_int(encoder->priv_data, "crf", rate_factor, 0);
    av_opt_set_int(encoder->priv_data, "mbtree", 0, 0);  // Debian's x264 gives other bytes from run to run with it
  } else {
    encoder->flags |= AV_CODEC_FLAG_QSCALE;
    encoder->global_quality = FF_QP2LAMBDA * std::max(1, rate_factor / 6);
  }
  if (output->oformat->flags & AVFMT_GLOBALHEADER) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  check(avcodec_open2(encoder.get(), codec, nullptr), "cannot be encoded");
}

void MovieWriter::State::open_file() {
  AVFormatContext* context = nullptr;
  const std::string url = "file:" + part_name(path).string();
  const int result = avformat_alloc_output_context2(&context, nullptr, "mp4", url.c_str());
  output.reset(context);
  check(result, "cannot be created");
  check(avio_open(&output->pb, output->url, AVIO_FLAG_WRITE), "cannot be created");
  output->flags |= AVFMT_FLAG_BITEXACT;  // no random numbers and no dates in the file
}

void MovieWriter::State::start() {
  open_encoder();
  stream = avformat_new_stream(output.get(), nullptr);
  stream->time_base = encoder->time_base;
  stream->avg_frame_rate = encoder->framerate;
  check(avcodec_parameters_from_context(stream->codecpar, encoder.get()), "cannot be encoded");
  av_opt_set(output->priv_data, "movflags", "+faststart", 0);
  check(avformat_write_header(output.get(), nullptr), "cannot be written");
  frame->format = encoder->pix_fmt;
  frame->width = encoder->width;
  frame->height = encoder->height;
  check(av_frame_get_buffer(frame.get(), 0), "cannot be encoded");
}

void MovieWriter::State::fill_frame(const cv::Mat& image) {
  check(av_frame_make_writable(frame.get()), "cannot be encoded");
  cv::Mat padded = image;
  if (image.cols != frame->width || image.rows != frame->height) {
    cv::copyMakeBorder(image, padded, 0, frame->height - image.rows, 0, frame->width - image.cols,
                       cv::BORDER_REPLICATE);
  }
  if (!scaler) {
    const AVPixelFormat from = image.type() == CV_8UC1 ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_BGR24;
    const int flags = SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT;
    scaler.reset(sws_getContext(frame->width, frame->height, from, frame->width, frame->height,
                                static_cast<AVPixelFormat>(frame->format), flags, nullptr, nullptr, nullptr));
    sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(SWS_CS_DEFAULT), 1, sws_getCoefficients(SWS_CS_ITU709),
                             0, 0, 1 << 16, 1 << 16);
  }
  const std::uint8_t* const rows[4] = {padded.data};
  const int steps[4] = {static_cast<int>(padded.step)};
  sws_scale(scaler.get(), rows, steps, 0, frame->height, frame->data, frame->linesize);
}

void MovieWriter::State::encode(const AVFrame* image) {
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

MovieWriter::MovieWriter(const std::filesystem::path& path, cv::Size size, double fps_hz, int rate_factor)
    : state_(std::make_unique<State>()) {
  av_log_set_level(AV_LOG_QUIET);  // faults are told by exceptions, not by libav on stderr
  state_->path = path;
  state_->size = size;
  state_->fps_hz = fps_hz;
  state_->rate_factor = rate_factor;
  state_->open_file();
}
MovieWriter::~MovieWriter() = default;
MovieWriter::MovieWriter(MovieWriter&&) noexcept = default;
MovieWriter& MovieWriter::operator=(MovieWriter&&) noexcept = default;

void MovieWriter::write(const cv::Mat& image) {
  State& s = *state_;
  if (s.next_index == 0) s.start();
  s.fill_frame(image);
  s.frame->pts = s.next_index++;
  s.encode(s.frame.get());
}

void MovieWriter::close() {
  State& s = *state_;
  s.encode(nullptr);
  s.check(av_write_trailer(s.output.get()), "cannot be written");
  s.check(avio_closep(&s.output->pb), "cannot be closed");
  commit_part(s.path);
  s.closed = true;
}

}  // namespace alidade
