// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace surf::pv {

/// The beginning of a library's name for a number, and the label of the property that it comes from.
using Labels = std::vector<std::pair<std::string, std::string>>;

/// What the libraries' jobs say of options of the command line is said of properties: "--pixel-size" is Pixel Size.
/// So is what they say of the numbers in `names`.
void with_labels(const std::function<void()>& request, const Labels& names = {});

}  // namespace surf::pv
