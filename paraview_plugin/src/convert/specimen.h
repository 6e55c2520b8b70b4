// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/core/edge.h"
#include "surf/mc/geometry/specimen.h"

class vtkDataArray;
class vtkDataObject;

namespace surf::pv {

// Texts that data of the Scene Reader carry, in their field data.
inline constexpr const char* material_text = "material";  // of a block
inline constexpr const char* edge_text = "edge";          // of an image of heights
inline constexpr const char* scene_text = "scene.file";   // of the whole: for materials of its own
inline constexpr const char* substrate_text = "substrate.material";  // of the whole
inline constexpr const char* substrate_top_text = "substrate.top_nm";

/// What is not said by the data.
struct SpecimenWish {
  std::string materials =
      "Si";  ///< names for bodies that do not say theirs, in their order; the last for the rest
  std::string material_file;  ///< of materials of the user's own; or empty
  std::string substrate;      ///< the material; empty: what the data say, else none
  double substrate_top_nm = 0;
  Edge edge = Edge::mirror;  ///< of a height field
};

/// A surface, an image of heights, or blocks of them as a specimen. A surface whose cells have the
/// array "surface", as the Surface Mesh Reader makes them, is a body for each of its numbers.
/// `heights` is of an image alone; a block's are z_nm or those that are shown.
mc::Specimen to_specimen(vtkDataObject* data, vtkDataArray* heights, const SpecimenWish& wish);

}  // namespace surf::pv
