// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/core/error.h"
#include "surf/core/module.h"

namespace surf::io {

/// The module's function table. If the module is missing, the error names `file`.
template <class Table>
const Table& module_for(const std::string& file) {
  try {
    return module<Table>();
  } catch (const Unsupported& error) {
    throw Unsupported(file, error.reason(), error.remedy());
  }
}

}  // namespace surf::io
