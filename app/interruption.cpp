// SPDX-License-Identifier: Apache-2.0
#include "app/interruption.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include "core/errors.h"

namespace alidade {
namespace {

constexpr int kWakeListener = SIGUSR1;  // sent to the listener alone, when the program ends by itself

sigset_t listened_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, kWakeListener);
  return signals;
}

void listen(std::stop_source source) {
  const sigset_t signals = listened_signals();
  int received = 0;
  while (sigwait(&signals, &received) == 0 && received != kWakeListener) {
    if (!source.request_stop()) _exit(static_cast<int>(ExitCode::Interrupted));
  }
}

}  // namespace

Interruption::Interruption() {
  const sigset_t signals = listened_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  listener_ = std::jthread([source = source_] { listen(source); });
}

Interruption::~Interruption() {
  pthread_kill(listener_.native_handle(), kWakeListener);
}

}  // namespace alidade
