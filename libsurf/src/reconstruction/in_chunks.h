// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/core/parallel.h"

namespace surf::reconstruction {

inline constexpr std::size_t chunks = 16;  // whatever the threads, so that sums are the same

/// Calls work(chunk, begin, end), each a part of `count`, in parallel.
template <class Work>
void in_chunks(std::size_t count, int threads, const Work& work) {
  parallel_for(chunks, threads, [&](std::size_t chunk, int) {
    work(chunk, chunk * count / chunks, (chunk + 1) * count / chunks);
  });
}

}  // namespace surf::reconstruction
