// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

struct AVCodecContext;
struct AVFrame;
struct AVPacket;
struct SwsContext;

namespace alidade {

struct FreeLibav {
  void operator()(AVCodecContext* p) const;
  void operator()(AVFrame* p) const;
  void operator()(AVPacket* p) const;
  void operator()(SwsContext* p) const;
};

/// What libav allocated, with its owner.
template <class T>
using LibavHandle = std::unique_ptr<T, FreeLibav>;

}  // namespace alidade
