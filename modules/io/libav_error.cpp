// SPDX-License-Identifier: Apache-2.0
#include "io/libav_error.h"

extern "C" {
#include <libavutil/error.h>
}

namespace alidade {

std::string libav_message(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(error, text, sizeof text);
  return text;
}

}  // namespace alidade
