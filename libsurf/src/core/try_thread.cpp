// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/try_thread.h"

#include <atomic>
#include <system_error>
#include <utility>

namespace surf {
namespace {

std::atomic<int> refused_threads{0};

}  // namespace

std::jthread try_thread(std::function<void()> work) {
  try {
    return std::jthread(std::move(work));
  } catch (const std::system_error&) {
    ++refused_threads;
    return {};
  }
}

int take_refused_threads() { return refused_threads.exchange(0); }

}  // namespace surf
