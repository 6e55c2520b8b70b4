// SPDX-License-Identifier: GPL-3.0-or-later
// 3MF (3MF Core Specification 1.3). Written here and not by lib3mf 1.8, which prints 6 digits after
// the point, refuses coordinates above 1e9, and gives every file random numbers.
#include "three_mf_write.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "files/plain_text.h"
#include "files/xml_text.h"
#include "files/zip_file.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mesh/check_mesh.h"
#include "three_mf_names.h"

namespace surf::io {
namespace {

class ThreeMfBuilder {
 public:
  ThreeMfBuilder(std::string file, const SceneView& scene)
      : file_(std::move(file)), scene_(scene), zip_(file_) {}

  std::string build() {
    add_part(
        "[Content_Types].xml",
        "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n"
        "<Default Extension=\"rels\" "
        "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n"
        "<Default Extension=\"model\" "
        "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n</Types>\n");
    add_part("_rels/.rels",
             fmt::format("<Relationships "
                         "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n"
                         "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" Type=\"{}\"/>\n"
                         "</Relationships>\n",
                         three_mf_model_relation));
    zip_.begin("3D/3dmodel.model");
    add_model();
    zip_.append(text_);
    return zip_.finish();
  }

 private:
  static constexpr const char* xml_head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

  void add_part(const char* name, const std::string& text) {
    zip_.begin(name);
    zip_.append(xml_head + text);
  }

  /// Microns where millimetres would be small numbers only.
  const ThreeMfUnit& unit() const {
    return three_mf_units[scene_.note.magnification < 1000 ? 0 : 1];
  }
  double scale() const { return scene_.note.magnification / unit().nm; }

  void add_model() {
    text_ =
        fmt::format("{}<model unit=\"{}\" xml:lang=\"en-US\" xmlns=\"{}\" xmlns:semsurf=\"{}\">\n",
                    xml_head, unit().name, three_mf_core, three_mf_own);
    add_metadata();
    text_ += "<resources>\n";
    std::string build = "<build>\n";
    for (std::size_t i = 0; i < scene_.surfaces.size(); ++i) {
      const SurfaceView& surface = scene_.surfaces[i];
      const Box box = bounds(*surface.mesh);
      const Vec3 center = box.lower_nm * 0.5 + box.upper_nm * 0.5;
      add_object(i + 1, surface, center);
      const Vec3 place = in_units(center);
      if (!is_finite(place)) refuse_size(surface);
      build += fmt::format("<item objectid=\"{}\" transform=\"1 0 0 0 1 0 0 0 1 {} {} {}\"/>\n",
                           i + 1, place.x, place.y, place.z);
    }
    text_ += "</resources>\n" + build + "</build>\n</model>\n";
  }

  void add_metadata() {
    nlohmann::json metadata = nlohmann::json::object();
    for (const auto& [key, value] : scene_.note.metadata) {
      check_plain_text(key, "a name in the metadata", file_);
      metadata[key] = as_plain_text(value);
    }
    const auto version = scene_.note.metadata.find("semsurf.version");
    add_metadata("Application", version == scene_.note.metadata.end()
                                    ? "semsurf"
                                    : "semsurf " + as_plain_text(version->second));
    const std::string factor = format_exact(scene_.note.magnification);
    const std::string exaggeration = format_exact(scene_.note.z_exaggeration);
    add_metadata("Description",
                 fmt::format("{} times as large as the specimen, heights {} times more", factor,
                             exaggeration));
    add_metadata(three_mf_unit, "nm");
    add_metadata(three_mf_magnification, factor);
    add_metadata(three_mf_exaggeration, exaggeration);
    add_metadata(three_mf_metadata, metadata.dump());
  }

  void add_metadata(const char* name, const std::string& value) {
    text_ += fmt::format("<metadata name=\"{}\">{}</metadata>\n", name, xml_escaped(value));
  }

  Vec3 in_units(const Vec3& p) const {
    return {p.x * scale(), p.y * scale(), p.z * scale() * scene_.note.z_exaggeration};
  }

  void add_object(std::size_t id, const SurfaceView& surface, const Vec3& center) {
    // An open sheet is a surface; a model is a body (4.1).
    const char* const type = check_mesh(*surface.mesh).closed_and_oriented ? "model" : "surface";
    text_ += fmt::format("<object id=\"{}\" type=\"{}\" name=\"{}\">\n<mesh>\n<vertices>\n", id,
                         type, xml_escaped(as_plain_text(surface.name)));
    for (const Vec3& v : surface.mesh->vertices_nm) {
      const Vec3 p = in_units(v - center);
      const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y),
                 z = static_cast<float>(p.z);
      if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) refuse_size(surface);
      fmt::format_to(std::back_inserter(text_), "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", x, y, z);
      pass_on();
    }
    text_ += "</vertices>\n<triangles>\n";
    for (std::size_t i = 0; i < surface.mesh->triangles.size(); ++i) {
      const Triangle& t = surface.mesh->triangles[i];
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
        throw InvalidInput(
            file_,
            fmt::format("triangle {} of '{}' has one vertex twice, which 3MF forbids", i,
                        surface.name),
            "Repair the mesh (semsurf mesh --repair), or write another format");
      }
      fmt::format_to(std::back_inserter(text_), "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", t[0],
                     t[1], t[2]);
      pass_on();
    }
    text_ += "</triangles>\n</mesh>\n</object>\n";
  }

  /// The text is packed as it grows: as a whole it can be half a gigabyte.
  void pass_on() {
    constexpr std::size_t enough = std::size_t{1} << 20;
    if (text_.size() < enough) return;
    zip_.append(text_);
    text_.clear();
  }

  [[noreturn]] void refuse_size(const SurfaceView& surface) const {
    throw InvalidInput(file_, fmt::format("the surface '{}' is too large for 3MF", surface.name),
                       "Check its unit, or use a smaller magnification");
  }

  std::string file_;
  const SceneView& scene_;
  ZipWriter zip_;
  std::string text_;  ///< not yet passed on
};

}  // namespace

std::string write_3mf(const std::string& file, const SceneView& scene) {
  return ThreeMfBuilder(file, scene).build();
}

}  // namespace surf::io
