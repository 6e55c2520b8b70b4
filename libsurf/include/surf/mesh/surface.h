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
  std::string name;           ///< valid by `is_scalar_name`: "height", "certainty"
  std::string unit;           ///< "nm", "1/nm"; "1" for plain numbers
  std::vector<float> values;  ///< one per vertex, finite
};

/// Whether a name consists of lower-case letters, digits and '_' and begins with a letter.
bool is_scalar_name(std::string_view name);
/// Converts a name from elsewhere to a valid name: "Elevation (nm)" to "elevation_nm", "_HEIGHT NM"
/// to "height_nm", "2nd" to "scalar_2nd". Valid names are unchanged.
std::string scalar_name(std::string_view name);

/// A grey picture projected onto a surface from straight above: each vertex shows the pixel at its
/// x and y. Places beyond the picture show its nearest edge.
struct Drape : Placement {
  std::string name;         ///< what it shows, such as "SE"
  Grid<std::uint8_t> grey;  ///< pixel (0, 0) is the lower-left pixel
};

/// A mesh with data at its vertices.
struct Surface {
  std::string name;  ///< the name in files, ParaView and viewers
  TriangleMesh mesh;
  std::vector<VertexScalar> scalars;  ///< unique names
  std::optional<Drape> drape;
};

/// The content of one file of surfaces.
struct SurfaceScene {
  std::vector<Surface> surfaces;  ///< one or more, unique names
  std::vector<Track> tracks;      ///< paths of electrons, or none
  /// Provenance, as in `Image`: keys are lower case with dots, and values do not depend on threads
  /// or clocks.
  std::map<std::string, std::string> metadata;
};

/// Throws InvalidInput (naming `subject`) if there is no surface, a mesh or track is damaged, a
/// name is empty, invalid or used twice, the number of values differs from the number of vertices,
/// a value is not finite, or a drape has no pixels or no positive finite pitch.
void validate(const SurfaceScene& scene, const char* subject = "surfaces");

}  // namespace surf
