// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::io {

/// The remedy of all readers for content that contradicts itself or ends too early.
inline constexpr const char* copy_again = "It is cut off or damaged: copy or export it again";

}  // namespace surf::io
