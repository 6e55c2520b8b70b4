// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/placement.h"
#include "surf/core/track.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// One number for each vertex of a mesh.
struct VertexScalar {
  std::string name;           ///< as `is_scalar_name` says: "height", "certainty"
  std::string unit;           ///< "nm", "1/nm"; "1" for plain numbers
  std::vector<float> values;  ///< one per vertex, finite
};

/// Lower-case letters, digits and '_', a letter first.
bool is_scalar_name(std::string_view name);
/// What others call a number, in that form: "Elevation (nm)" is "elevation_nm", "_HEIGHT NM"
/// "height_nm", "2nd" "scalar_2nd". Names of that form stay.
std::string scalar_name(std::string_view name);

/// A grey picture laid on a surface from straight above: each vertex shows the pixel over its x and
/// y. Places beyond the picture show its nearest edge.
struct Drape : Placement {
  std::string name;         ///< what it shows, as "SE"
  Grid<std::uint8_t> grey;  ///< pixel (0, 0) is the lower-left one
};

/// A mesh with what is known about its places.
struct Surface {
  std::string name;  ///< as files, ParaView and viewers show it
  TriangleMesh mesh;
  std::vector<VertexScalar> scalars;  ///< unique names
  std::optional<Drape> drape;
};

/// All that one file of surfaces shows.
struct SurfaceScene {
  std::vector<Surface> surfaces;  ///< one or more, unique names
  std::vector<Track> tracks;      ///< paths of electrons, or none
  /// Provenance; as in `Image`: keys are lower case with dots, nothing depends on threads or
  /// clocks.
  std::map<std::string, std::string> metadata;
};

/// Throws InvalidInput (naming `subject`) if there is no surface, a mesh or track is damaged, a
/// name is empty, not of the form said above or used twice, the number of values is not that of the
/// vertices, a value is not finite, or a drape has no pixels or no positive finite pitch.
void validate(const SurfaceScene& scene, const char* subject = "surfaces");

}  // namespace surf
