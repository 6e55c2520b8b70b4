// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "surf/io/height_field_file.h"
#include "surf/io/mesh_unit.h"
#include "surf/io/web_page.h"
#include "surf/mesh/surface.h"
#include "surf/workflow/picture_input.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

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
};

/// A web page in the making (`semsurf view`): surfaces, then what is laid on them. Names are made
/// unique. Throws UsageError, InvalidInput, FileError, Interrupted.
class ViewPage {
 public:
  using Metadata = std::map<std::string, std::string>;

  explicit ViewPage(ViewReading reading, Reporter reporter = {});

  /// Adds what the file holds: height fields, bodies of a mesh file, pictures. An image with a
  /// channel in nm ("z_nm", "surface") is a height field with the others as its scalars.
  void add(const FileChannel& input);
  void add(HeightField field, const std::string& name, Metadata metadata = {});
  void add(TriangleMesh mesh, const std::string& name, Metadata metadata = {});
  /// As an image in a file; `channel` empty: all of them.
  void add(Image image, const std::string& name, const std::string& channel = {});

  /// Lays a map on the surfaces that it fits, and colours them by the first one.
  void add_scalar(const FileChannel& input);
  void add_scalar(const Image& image, const std::string& channel, const std::string& name);

  /// Lays a picture on the surfaces.
  void drape(const FileChannel& input);
  void drape(Image image, const std::string& channel, const std::string& name);

  io::WebPage& page() { return page_; }

 private:
  void add_field(HeightField field, const std::string& name, Metadata metadata,
                 std::vector<io::WebScalar> scalars);
  void add_meshes(const FileChannel& input);
  void add_picture(io::WebImage picture, const std::string& surface_name,
                   const std::string& channel);
  void add_drape_of(const Drape& drape, const std::string& surface);
  void add_body(Surface body, Metadata metadata);
  void lay(io::WebImage picture, const std::string& channel);
  void note(const std::string& text) const;

  ViewReading reading_;
  Reporter reporter_;
  io::WebPage page_;
  std::string of_;  ///< what notes are about
};

/// Every so many-th sample from the lower-left one on.
HeightField every_sample(const HeightField& field, int step);

}  // namespace surf::workflow
