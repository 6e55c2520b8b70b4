// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/image.h"
#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::io {

/// One number for each vertex of a mesh or each sample of a height field (row by row, the lowest
/// first).
struct WebScalar {
  std::string name;           ///< any text
  std::string unit;           ///< "nm"; "1" or empty for plain numbers
  std::vector<float> values;  ///< NaN: the value is unknown there
};

/// A surface that the page shows in 3D. A height field stays a grid of heights (float32 about the
/// middle of their range, exact to 6e-8 of it), which takes a quarter of the bytes of triangles.
/// Its holes stay open.
struct WebSurface {
  std::string name;
  std::variant<TriangleMesh, HeightField> shape;
  std::vector<WebScalar> scalars;               ///< unique names
  std::map<std::string, std::string> metadata;  ///< facts about it, shown under About
};

/// An image shown beside the surfaces, one picture per channel ("valid" is a mask, not a picture),
/// in 256 greys between its 0.5 and 99.5 percentiles. A picture can be laid on the surfaces that it
/// covers.
struct WebImage {
  std::string name;
  Image image;
  /// False: pitch and origin mean nothing; there is no scale bar, and the image is not laid on
  /// surfaces.
  bool has_scale = true;
};

/// A channel of one of the page's images, to be laid on the surfaces.
struct WebDrape {
  std::size_t image = 0;
  std::string channel;
};

struct WebPage {
  std::string title;
  std::vector<WebSurface> surfaces;  ///< unique names
  std::vector<WebImage> images;
  std::map<std::string, std::string> metadata;  ///< provenance of the page, shown under About
  std::string scalar;  ///< the scalar that first colours the surfaces; empty: their height
  std::optional<WebDrape> drape;  ///< the picture that first lies on the surfaces
};

struct WebPageSummary {
  std::size_t bytes = 0;         ///< size of the file
  std::size_t viewer_bytes = 0;  ///< the part of it that is the viewer program
};

/// Writes one HTML file that shows the surfaces in any browser. It needs nothing else and fetches
/// nothing: see docs/how-to/view.md. The same page gives the same bytes. The progress monitor
/// counts surfaces and images. Throws Interrupted before anything is written; InvalidInput for a
/// page with neither surface nor image, a damaged mesh, field, image or scalar, a name that is
/// empty or used twice, or a drape or scalar that does not exist; FileError; UsageError for a name
/// that does not end in .html; Unsupported if the viewer was not built.
WebPageSummary write_web_page(const std::filesystem::path& path, const WebPage& page,
                              const Watch& watch = {});

/// Throws what `write_web_page` would throw for the name, folder or build, before any work is
/// spent.
void check_web_page_target(const std::filesystem::path& path);

}  // namespace surf::io
