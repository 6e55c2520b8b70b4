// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace surf {

/// Memory of this size or more is worth asking for large pages: 4 MB.
inline constexpr std::size_t large_memory_bytes = std::size_t{4} << 20;

/// Asks the system to back memory that has not been written yet with large pages (2 MB in place of
/// 4 kB). The first write to a page of new memory costs about a microsecond, for a large image as
/// much as computing it. Does nothing for less than `large_memory_bytes`, where the system has no
/// such pages, or where its administrator does not allow them; values never depend on it.
void prefer_large_pages(void* begin, std::size_t bytes) noexcept;

}  // namespace surf
