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

/// One number for each vertex of a mesh or sample of a height field (row by row, the lowest first).
struct WebScalar {
  std::string name;           ///< any text
  std::string unit;           ///< "nm"; "1" or empty for plain numbers
  std::vector<float> values;  ///< NaN: nothing is known there
};

/// What the page shows in 3D. A height field stays a grid of heights (float32 about the middle of
/// their range, to 6e-8 of it): a quarter of the bytes of triangles. Its holes stay open.
struct WebSurface {
  std::string name;
  std::variant<TriangleMesh, HeightField> shape;
  std::vector<WebScalar> scalars;               ///< unique names
  std::map<std::string, std::string> metadata;  ///< what is known of it: shown under About
};

/// A picture beside the surfaces, one per channel ("valid" is a mask, not a picture), in 256 greys
/// between its 0.5 and 99.5 percentiles. It can be laid on the surfaces that it lies over.
struct WebImage {
  std::string name;
  Image image;
  bool has_scale =
      true;  ///< false: its pitch and origin mean nothing; no scale bar, not to be laid on anything
};

/// A channel of one of the page's images.
struct WebDrape {
  std::size_t image = 0;
  std::string channel;
};

struct WebPage {
  std::string title;
  std::vector<WebSurface> surfaces;  ///< unique names
  std::vector<WebImage> images;
  std::map<std::string, std::string> metadata;  ///< provenance of the page, for About
  std::string scalar;             ///< what colours the surfaces at first; empty: their height
  std::optional<WebDrape> drape;  ///< what lies on them at first
};

struct WebPageSummary {
  std::size_t bytes = 0;         ///< of the file
  std::size_t viewer_bytes = 0;  ///< of these the program that shows it
};

/// One HTML file that shows the surfaces in any browser, with nothing else needed and nothing
/// fetched: see docs/methods/view.md. The same page gives the same bytes. The watch counts
/// surfaces and images. Throws Interrupted before anything is written; InvalidInput for a page with
/// neither surface nor image, a damaged mesh, field, image or scalar, a name that is empty or used
/// twice, or a drape or scalar that is not there; FileError; UsageError for a name that does not
/// end in .html; Unsupported where the viewer was not built.
WebPageSummary write_web_page(const std::filesystem::path& path, const WebPage& page,
                              const Watch& watch = {});

/// Throws what `write_web_page` would for the name, folder or build, before any work is spent.
void check_web_page_target(const std::filesystem::path& path);

}  // namespace surf::io
