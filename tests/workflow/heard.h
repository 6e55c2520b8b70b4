// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/workflow/reporter.h"

namespace surf::test {

/// What a job said.
struct Heard {
  std::vector<std::string> notes, warnings;
  double furthest = 0;  ///< the largest share of the work that was told

  workflow::Reporter reporter() {
    workflow::Reporter r;
    r.on_note = [this](const std::string& text) { notes.push_back(text); };
    r.on_warning = [this](const std::string& text) { warnings.push_back(text); };
    r.on_progress = [this](double done, double total, std::string_view) {
      if (total > 0 && done / total > furthest) furthest = done / total;
    };
    return r;
  }
};

}  // namespace surf::test
