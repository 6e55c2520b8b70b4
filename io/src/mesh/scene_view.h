// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/image.h"
#include "surf/mesh/surface.h"
#include "surface_note.h"

namespace surf::io {

/// A writer's view of a surface. Nothing is copied: the data must outlive the view.
struct SurfaceView {
  std::string_view name;
  const TriangleMesh* mesh = nullptr;
  std::span<const VertexScalar> scalars;
  const Drape* drape = nullptr;  ///< null: no drape
};

/// The content of one output file, and the note on how its numbers are meant.
struct SceneView {
  std::vector<SurfaceView> surfaces;
  std::span<const Track> tracks;
  SurfaceNote note;
};

/// A view of the scene in nm. `scene` must outlive the result.
SceneView view_of(const SurfaceScene& scene);

/// One of a format's output files. The main file comes last and has the requested path. The others
/// lie beside it, with names that begin with its stem.
struct OutputFile {
  std::filesystem::path path;
  std::string content;
};

/// The scalars that all surfaces have in the same unit: for each scalar, its values in every
/// surface. Formats that join several surfaces into one hold these.
std::vector<std::vector<const VertexScalar*>> common_scalars(const SceneView& scene);

/// The position of a place in the picture, from 0 (left, below) to 1. Places beyond the picture get
/// its outermost pixels.
struct TexturePoint {
  double u = 0;
  double v = 0;
};
TexturePoint texture_point(const Drape& drape, const Vec3& place_nm);

/// Formats the picture as an 8-bit PNG that states its name and place.
std::string format_drape(const std::string& file, const Drape& drape);
Image to_image(const Drape& drape);
/// Reads a picture of `format_drape`, PNG or VTI.
Drape read_drape(const std::filesystem::path& path);

}  // namespace surf::io
