// SPDX-License-Identifier: Apache-2.0
#include "io/lossless_planes.h"

extern "C" {
#include <libavutil/frame.h>
}

#include <array>
#include <vector>

#include <opencv2/core.hpp>

namespace alidade {
namespace {

cv::Mat plane(const AVFrame& frame, int index, cv::Size size, int type) {
  return {size, type, frame.data[index], static_cast<std::size_t>(frame.linesize[index])};
}

cv::Size half(const AVFrame& frame, PixelLayout layout) {
  return {frame.width / 2, layout == PixelLayout::Nv12 ? frame.height / 2 : frame.height};
}

// FFV1 takes colours as BGR0, ffvhuff as RGB; both give BGR0.
void bgr_to_planes(const cv::Mat& image, AVFrame& frame) {
  if (frame.format == AV_PIX_FMT_RGB24) {
    cv::Mat rgb = plane(frame, 0, image.size(), CV_8UC3);
    const std::array<int, 6> swap{0, 2, 1, 1, 2, 0};
    cv::mixChannels(&image, 1, &rgb, 1, swap.data(), 3);
    return;
  }
  cv::Mat bgr0 = plane(frame, 0, image.size(), CV_8UC4);
  const std::array<int, 8> add{0, 0, 1, 1, 2, 2, -1, 3};
  cv::mixChannels(&image, 1, &bgr0, 1, add.data(), 4);
}

cv::Mat bgr_from_planes(const AVFrame& frame) {
  const cv::Size size(frame.width, frame.height);
  cv::Mat image(size, CV_8UC3);
  const cv::Mat bgr0 = plane(frame, 0, size, CV_8UC4);
  const std::array<int, 6> keep{0, 0, 1, 1, 2, 2};
  cv::mixChannels(&bgr0, 1, &image, 1, keep.data(), 3);
  return image;
}

// As Y U Y V, seen two by two pixels: luma is every second byte, the differences every fourth.
void yuyv_to_planes(const cv::Mat& image, AVFrame& frame) {
  cv::Mat luma = plane(frame, 0, image.size(), CV_8UC1);
  cv::extractChannel(image, luma, 0);
  const cv::Mat pairs(image.rows, image.cols / 2, CV_8UC4, image.data, image.step);
  std::array<cv::Mat, 2> differences{plane(frame, 1, pairs.size(), CV_8UC1), plane(frame, 2, pairs.size(), CV_8UC1)};
  const std::array<int, 4> split{1, 0, 3, 1};
  cv::mixChannels(&pairs, 1, differences.data(), 2, split.data(), 2);
}

cv::Mat yuyv_from_planes(const AVFrame& frame) {
  cv::Mat image(frame.height, frame.width, CV_8UC2);
  cv::insertChannel(plane(frame, 0, image.size(), CV_8UC1), image, 0);
  cv::Mat pairs(image.rows, image.cols / 2, CV_8UC4, image.data, image.step);
  const std::array<cv::Mat, 2> differences{plane(frame, 1, pairs.size(), CV_8UC1),
                                           plane(frame, 2, pairs.size(), CV_8UC1)};
  const std::array<int, 4> join{0, 1, 1, 3};
  cv::mixChannels(differences.data(), 2, &pairs, 1, join.data(), 2);
  return image;
}

void nv12_to_planes(const cv::Mat& image, AVFrame& frame) {
  image.rowRange(0, frame.height).copyTo(plane(frame, 0, {frame.width, frame.height}, CV_8UC1));
  const cv::Size size = half(frame, PixelLayout::Nv12);
  const cv::Mat both(size, CV_8UC2, const_cast<unsigned char*>(image.ptr(frame.height)), image.step);
  std::array<cv::Mat, 2> differences{plane(frame, 1, size, CV_8UC1), plane(frame, 2, size, CV_8UC1)};
  const std::array<int, 4> split{0, 0, 1, 1};
  cv::mixChannels(&both, 1, differences.data(), 2, split.data(), 2);
}

cv::Mat nv12_from_planes(const AVFrame& frame) {
  cv::Mat image(frame.height * 3 / 2, frame.width, CV_8UC1);
  plane(frame, 0, {frame.width, frame.height}, CV_8UC1).copyTo(image.rowRange(0, frame.height));
  const cv::Size size = half(frame, PixelLayout::Nv12);
  cv::Mat both(size, CV_8UC2, image.ptr(frame.height), image.step);
  const std::array<cv::Mat, 2> differences{plane(frame, 1, size, CV_8UC1), plane(frame, 2, size, CV_8UC1)};
  const std::array<int, 4> join{0, 0, 1, 1};
  cv::mixChannels(differences.data(), 2, &both, 1, join.data(), 2);
  return image;
}

}  // namespace

int libav_format(PixelLayout layout, LosslessCodec codec) {
  const bool is_raw = codec == LosslessCodec::Raw;
  switch (layout) {
    case PixelLayout::Grey8:
      return AV_PIX_FMT_GRAY8;
    case PixelLayout::Grey16:
      return AV_PIX_FMT_GRAY16LE;
    case PixelLayout::Bgr24:
      if (is_raw) return AV_PIX_FMT_BGR24;
      return codec == LosslessCodec::Ffv1 ? AV_PIX_FMT_BGR0 : AV_PIX_FMT_RGB24;
    case PixelLayout::Yuyv:
      return is_raw ? AV_PIX_FMT_YUYV422 : AV_PIX_FMT_YUV422P;
    case PixelLayout::Nv12:
      return is_raw ? AV_PIX_FMT_NV12 : AV_PIX_FMT_YUV420P;
    case PixelLayout::Jpeg:
      break;
  }
  return AV_PIX_FMT_NONE;
}

void to_planes(const cv::Mat& image, PixelLayout layout, AVFrame& frame) {
  if (layout == PixelLayout::Bgr24) return bgr_to_planes(image, frame);
  if (layout == PixelLayout::Yuyv) return yuyv_to_planes(image, frame);
  if (layout == PixelLayout::Nv12) return nv12_to_planes(image, frame);
  image.copyTo(plane(frame, 0, image.size(), image.type()));
}

bool is_from_planes(int decoded, PixelLayout layout) {
  if (layout == PixelLayout::Bgr24) return decoded == AV_PIX_FMT_BGR0;
  return decoded == libav_format(layout, LosslessCodec::Ffv1);
}

cv::Mat from_planes(const AVFrame& frame, PixelLayout layout) {
  if (layout == PixelLayout::Bgr24) return bgr_from_planes(frame);
  if (layout == PixelLayout::Yuyv) return yuyv_from_planes(frame);
  if (layout == PixelLayout::Nv12) return nv12_from_planes(frame);
  return plane(frame, 0, {frame.width, frame.height}, mat_type(layout)).clone();
}

}  // namespace alidade
