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

/// A surface as writers see it. Nothing is copied: what it points to outlives it.
struct SurfaceView {
  std::string_view name;
  const TriangleMesh* mesh = nullptr;
  std::span<const VertexScalar> scalars;
  const Drape* drape = nullptr;  ///< or nullptr
};

/// What one file shows, and how its numbers are meant.
struct SceneView {
  std::vector<SurfaceView> surfaces;
  std::span<const Track> tracks;
  SurfaceNote note;
};

/// The scene as it is in nm. `scene` outlives the result.
SceneView view_of(const SurfaceScene& scene);

/// A file that a format is made of. The main one comes last and has the path asked for; the others
/// lie beside it, under names that begin with its stem.
struct OutputFile {
  std::filesystem::path path;
  std::string content;
};

/// For each scalar that all surfaces have in the same unit: where each has it. Formats that make
/// one of several surfaces hold these.
std::vector<std::vector<const VertexScalar*>> common_scalars(const SceneView& scene);

/// Where the picture shows this place, from 0 (left, below) to 1; beyond the picture its outermost
/// pixels.
struct TexturePoint {
  double u = 0;
  double v = 0;
};
TexturePoint texture_point(const Drape& drape, const Vec3& place_nm);

/// The picture as a PNG of 8 bits that says its name and place.
std::string format_drape(const std::string& file, const Drape& drape);
Image to_image(const Drape& drape);
/// From a picture that was written so, PNG or VTI.
Drape read_drape(const std::filesystem::path& path);

}  // namespace surf::io
