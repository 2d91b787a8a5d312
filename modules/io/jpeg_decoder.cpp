// SPDX-License-Identifier: Apache-2.0
#include "io/jpeg_decoder.h"

#include <csetjmp>
#include <cstdio>

// clang-format off: these need the headers before them and do not include them
#include <jerror.h>
#include <jpeglib.h>
// clang-format on

namespace alidade {
namespace {

/// libjpeg's error handler and what it was told.
struct ErrorLog {
  jpeg_error_mgr handler{};  // first: libjpeg knows the log by this member's address
  std::jmp_buf after_error;
  char damage[JMSG_LENGTH_MAX] = {};
};

ErrorLog& log_of(j_common_ptr jpeg) {
  return *reinterpret_cast<ErrorLog*>(jpeg->err);
}

void keep_message(j_common_ptr jpeg) {
  ErrorLog& log = log_of(jpeg);
  if (log.damage[0] == '\0') jpeg->err->format_message(jpeg, log.damage);
}

// libjpeg must not return from an error, and is C: no exception may pass through it.
[[noreturn]] void leave(j_common_ptr jpeg) {
  keep_message(jpeg);
  std::longjmp(log_of(jpeg).after_error, 1);
}

// Level -1 is a warning. A few bytes of padding before a marker and odd headers harm no pixel, and some cameras write
// them; many bytes left over mean that the code before them was not decoded as it was written.
void note(j_common_ptr jpeg, int level) {
  constexpr int kPadding = 16;
  const auto& error = *jpeg->err;
  const bool padding = error.msg_code == JWRN_EXTRANEOUS_DATA && error.msg_parm.i[0] <= kPadding;
  const bool odd_header = error.msg_code == JWRN_ADOBE_XFORM || error.msg_code == JWRN_JFIF_MAJOR;
  if (level < 0 && !padding && !odd_header) keep_message(jpeg);
}

// Reads all rows into `image`. False after an error. Holds no object that longjmp would leave undestroyed.
bool read_rows(jpeg_decompress_struct& jpeg, ErrorLog& log, std::string_view bytes, cv::Mat& image) {
  if (setjmp(log.after_error) != 0) return false;
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&jpeg, TRUE);
  if (jpeg.num_components != 1 && jpeg.num_components != 3) return true;
  jpeg.out_color_space = jpeg.num_components == 1 ? JCS_GRAYSCALE : JCS_EXT_BGR;
  jpeg_start_decompress(&jpeg);
  const int width = static_cast<int>(jpeg.output_width), height = static_cast<int>(jpeg.output_height);
  image.create(height, width, jpeg.num_components == 1 ? CV_8UC1 : CV_8UC3);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = image.ptr(static_cast<int>(jpeg.output_scanline));
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

}  // namespace

bool is_jpeg(std::string_view bytes) {
  return bytes.starts_with("\xFF\xD8\xFF");
}

std::optional<DecodedJpeg> decode_jpeg(std::string_view bytes) {
  jpeg_decompress_struct jpeg{};
  ErrorLog log;
  jpeg.err = jpeg_std_error(&log.handler);
  log.handler.error_exit = leave;
  log.handler.emit_message = note;
  DecodedJpeg decoded;
  const bool complete = read_rows(jpeg, log, bytes, decoded.image);
  jpeg_destroy_decompress(&jpeg);
  if (complete && decoded.image.empty() && log.damage[0] == '\0') return std::nullopt;
  if (!complete) decoded.image.release();
  if (log.damage[0] != '\0') decoded.damage = log.damage;
  return decoded;
}

}  // namespace alidade
