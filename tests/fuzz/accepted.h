// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/image.h"
#include "surf/mesh/surface.h"
#include "surf/sem/trained_model.h"

namespace surf::test {

/// The data that a reader returned, for the steps that follow.
struct Accepted {
  std::optional<SurfaceScene> surfaces = {};
  std::vector<HeightField> fields = {};
  std::optional<Image> image = {};
  std::optional<TrainedModel> model = {};
};

/// Validates the data. Throws std::logic_error if they are invalid: readers must not return such.
void expect_valid(const Accepted& accepted);

/// Takes the data through the steps that users take: meshes are checked, repaired, measured,
/// simplified, written in each format and read again; scans are levelled, cleaned, eroded, shown to
/// a fast model, written and read again; models predict. Large data are left out. Throws the
/// project's errors, and std::logic_error if a step returns invalid data or a file is not read
/// again.
void go_on_with(const Accepted& accepted);

}  // namespace surf::test
