// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace surf::pv {

/// The beginning of a library's name for a number, and the label of the property that it comes
/// from.
using Labels = std::vector<std::pair<std::string, std::string>>;

/// A message of the libraries with each field in it, `scan.pixel_size`, as a property: Pixel Size.
std::string labelled(const std::string& text);

/// What the libraries' jobs refuse is said of properties: so are fields, and the numbers in
/// `names`.
void with_labels(const std::function<void()>& request, const Labels& names = {});

}  // namespace surf::pv
