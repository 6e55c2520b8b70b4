// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/io/plot.h"

namespace surf::io {

/// Throws InvalidInput, naming `file` and the place in the plot, for data that `Plot` does not
/// admit.
void check_plot(const Plot& plot, const std::string& file);

}  // namespace surf::io
