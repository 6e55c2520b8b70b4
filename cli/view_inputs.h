// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "picture_input.h"
#include "surf/core/progress.h"
#include "surf/io/height_field_file.h"
#include "surf/io/mesh_unit.h"
#include "surf/io/web_page.h"

namespace surf::cli {

/// How large what is shown may be.
struct ViewParameters {
  std::optional<double>
      mesh_tolerance_nm;  ///< height fields and meshes become fewer triangles within it
  int every = 1;          ///< every so many-th sample of height fields
};

void describe(ParameterVisitor& visit, ViewParameters& parameters);

struct ViewReading : ViewParameters {
  io::MeshUnit unit;
  io::HeightReadOptions heights;  ///< of scans that do not say
  GivenPitch pitch;               ///< of pictures that do not say
  bool quiet = false;
  Watch watch;  ///< of what lasts; is told nothing
};

/// Adds what the file holds to the page: height fields, bodies of a mesh file, pictures. An image
/// with a channel in nm ("z_nm", "surface") is a height field with the others as its scalars. Names
/// are made unique.
void add_view_input(const FileChannel& input, const ViewReading& reading, io::WebPage& page);

/// Every so many-th sample from the lower-left one on.
HeightField every_sample(const HeightField& field, int step);

/// "name", "name 2" ...: what no surface of the page is called yet.
std::string unique_name(const io::WebPage& page, const std::string& name);

}  // namespace surf::cli
