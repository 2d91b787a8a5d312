// SPDX-License-Identifier: Apache-2.0
#include "io/libav_handles.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libswscale/swscale.h>
}

namespace alidade {

void FreeLibav::operator()(AVCodecContext* p) const {
  avcodec_free_context(&p);
}
void FreeLibav::operator()(AVFrame* p) const {
  av_frame_free(&p);
}
void FreeLibav::operator()(AVPacket* p) const {
  av_packet_free(&p);
}
void FreeLibav::operator()(SwsContext* p) const {
  sws_freeContext(p);
}

}  // namespace alidade
