// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/background_release.h"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace alidade {
namespace {

struct Running {
  std::mutex mutex;
  std::condition_variable ended;
  int count = 0;
};

// Shared with the threads, which may outlive the end of main().
struct Releases {
  std::shared_ptr<Running> running = std::make_shared<Running>();

  ~Releases() {
    std::unique_lock lock(running->mutex);
    running->ended.wait_for(lock, std::chrono::seconds(1), [this] { return running->count == 0; });
  }
};

std::shared_ptr<Running> running() {
  static const Releases releases;
  return releases.running;
}

}  // namespace

void release_in_background(std::function<void()> release) {
  const auto all = running();
  {
    const std::scoped_lock lock(all->mutex);
    ++all->count;
  }
  std::thread([all, release = std::move(release)]() mutable {
    release();
    release = nullptr;
    const std::scoped_lock lock(all->mutex);
    --all->count;
    all->ended.notify_all();
  }).detach();
}

int background_releases() {
  const auto all = running();
  const std::scoped_lock lock(all->mutex);
  return all->count;
}

}  // namespace alidade
