// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <thread>

namespace surf {

/// Starts a thread that runs `work`, which must not throw. The result is not joinable if the system
/// refuses another thread: the caller then runs the work itself, or reports the failure.
std::jthread try_thread(std::function<void()> work);

/// The number of threads that the system has refused to this process since the last call.
/// `parallel_for` finishes its work in any case, with fewer threads.
int take_refused_threads();

}  // namespace surf
