// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace surf::pv {

/// What the libraries' jobs say of options of the command line is said of properties: "--pixel-size" is Pixel Size.
void with_labels(const std::function<void()>& request);

}  // namespace surf::pv
