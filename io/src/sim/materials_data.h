// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::io {

/// The text of data/materials.toml.
extern const char* const materials_toml;

}  // namespace surf::io
