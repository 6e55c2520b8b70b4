// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::io {

/// The text of plot.py.
extern const char* const plot_script;

}  // namespace surf::io
