// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <thread>

namespace surf {

/// A thread that does `work`, which must not throw. Not joinable where the system refuses another
/// thread: the caller then does the work, or says that it cannot be done.
std::jthread try_thread(std::function<void()> work);

/// How many threads the system has refused to this process since this was asked last.
/// `parallel_for` does its work all the same, with fewer.
int take_refused_threads();

}  // namespace surf
