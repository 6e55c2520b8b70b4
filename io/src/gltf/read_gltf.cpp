// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <type_traits>
#include <utility>

#include "document.h"
#include "mesh/file_unit.h"
#include "mesh/mesh_format.h"
#include "mesh/surface_names.h"
#include "names.h"
#include "raster/image_formats.h"
#include "shown_meshes.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "write_gltf.h"

namespace surf::io {
namespace {

/// An object in a mesh's extras, which can be anything in files of others.
std::optional<JsonValue> extra(const JsonValue& mesh, const char* key) {
  const auto extras = mesh.find("extras");
  return extras && extras->is_object() ? extras->find(key) : std::nullopt;
}

TrackKind kind_of(const JsonValue& tracks) {
  const std::string name = tracks.require("kind").text();
  for (const TrackKind kind : {TrackKind::absorbed, TrackKind::se, TrackKind::bse,
                               TrackKind::transmitted, TrackKind::lost}) {
    if (name == name_of(kind)) return kind;
  }
  tracks.fail("its kind is not known");
}

template <class T>
T whole(double value, const JsonValue& place) {
  constexpr double most = 0x1p53;  // whole numbers up to here are exact
  const double high = std::min(most, static_cast<double>(std::numeric_limits<T>::max()));
  const double low = std::is_signed_v<T> ? -high : 0;
  if (!(value >= low && value <= high) || value != std::floor(value)) {
    place.fail(fmt::format("{} is not a whole number that fits here", value));
  }
  return static_cast<T>(value);
}

class SceneParser {
 public:
  SceneParser(const std::filesystem::path& path, std::string_view content, const MeshUnit& unit)
      : path_(path), document_(path, content),
        unit_nm_(file_unit_nm(unit, document_.unit_nm, path.string())),
        instances_(gltf_instances(document_.root)) {
    check_gltf_size(document_, instances_);
  }

  ParsedFile parse() {
    ParsedFile parsed;
    UniqueNames unique;
    for (const GltfBody& body : gltf_bodies(document_, instances_)) {
      parsed.bodies.push_back({{}, surface(body)});
      std::string& name = parsed.bodies.back().surface.name;
      name = unique(name);
    }
    if (document_.is_own()) {
      for (const GltfInstance& instance : instances_) add_tracks(instance);
    }
    std::stable_sort(tracks_.begin(), tracks_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& [place, track] : tracks_) parsed.tracks.push_back(std::move(track));
    parsed.note.metadata = document_.metadata();
    parsed.is_in_nm = true;
    return parsed;
  }

 private:
  Surface surface(const GltfBody& body) {
    Surface result{body.name.empty() ? path_.stem().string() : body.name, {}, {}, {}};
    for (const JsonValue& primitive : body.primitives) {
      append_triangles(document_, primitive, body.instance->to_scene, result.mesh);
    }
    to_nm(result.mesh.vertices_nm);
    add_scalars(body, result);
    if (document_.is_own()) result.drape = drape(body);
    return result;
  }

  void to_nm(std::vector<Vec3>& points) const {
    for (Vec3& p : points) {
      p *= unit_nm_;
      if (is_finite(p)) continue;
      throw FileError(
          path_.string(),
          fmt::format("its coordinates are too large for a unit of {} nm", format_exact(unit_nm_)),
          "Check the unit");
    }
  }

  /// Names and units as semsurf noted them, else what the attributes' own names suggest.
  static std::vector<std::pair<std::string, VertexScalar>> announced(const GltfBody& body) {
    std::vector<std::pair<std::string, VertexScalar>> scalars;  // attribute, its name and unit
    if (const auto extras = extra(body.instance->mesh, gltf_scalars_key)) {
      for (const JsonValue& item : body.instance->mesh.require("extras").items(gltf_scalars_key)) {
        const std::string name = item.require("name").text();
        if (!is_scalar_name(name)) item.fail("its name is not one that a scalar can have");
        scalars.push_back(
            {item.require("attribute").text(), {name, item.require("unit").text(), {}}});
      }
      return scalars;
    }
    for (const std::string& key : body.primitives.front().require("attributes").keys()) {
      if (key.starts_with('_')) scalars.push_back({key, {scalar_name(key), "1", {}}});
    }
    return scalars;
  }

  void add_scalars(const GltfBody& body, Surface& surface) {
    std::set<std::string> names;
    for (auto& [attribute, scalar] : announced(body)) {
      if (!has_everywhere(body, attribute)) continue;
      while (!names.insert(scalar.name).second) scalar.name += "_";
      for (const JsonValue& primitive : body.primitives)
        append_values(primitive, attribute, scalar.values);
      if (scalar.values.size() != surface.mesh.vertices_nm.size()) {
        body.instance->mesh.fail(fmt::format("{} has {} values for {} vertices", attribute,
                                             scalar.values.size(),
                                             surface.mesh.vertices_nm.size()));
      }
      surface.scalars.push_back(std::move(scalar));
    }
  }

  /// Whether every part of the body has one number per vertex under that name.
  bool has_everywhere(const GltfBody& body, const std::string& attribute) const {
    return std::all_of(body.primitives.begin(), body.primitives.end(),
                       [&](const JsonValue& primitive) {
                         const auto accessor = primitive.require("attributes").find(attribute);
                         return accessor && document_.accessors.is_scalar(accessor->whole());
                       });
  }

  void append_values(const JsonValue& primitive, const std::string& attribute,
                     std::vector<float>& values) {
    const auto accessor = primitive.require("attributes").require(attribute).whole();
    const std::vector<float> more = document_.accessors.scalars(accessor);
    values.insert(values.end(), more.begin(), more.end());
  }

  std::optional<Drape> drape(const GltfBody& body) {
    const auto noted = extra(body.instance->mesh, gltf_drape_key);
    const auto material = body.primitives.front().find("material");
    if (!noted || !material) return {};
    const JsonValue& root = document_.root;
    const JsonValue look =
        root.item("materials", material->whole()).require("pbrMetallicRoughness");
    const auto texture = look.find("baseColorTexture");
    if (!texture) return {};  // taken away by another program
    const auto source = root.item("textures", texture->require("index").whole()).require("source");
    Drape drape;
    drape.name = noted->require("name").text();
    drape.pitch_x_nm = noted->require("pitch_x_nm").number();
    drape.pitch_y_nm = noted->require("pitch_y_nm").number();
    drape.origin_x_nm = noted->require("origin_x_nm").number();
    drape.origin_y_nm = noted->require("origin_y_nm").number();
    if (!(drape.pitch_x_nm > 0) || !(drape.pitch_y_nm > 0))
      noted->fail("pixels have a size above 0");
    const JsonValue image = root.item("images", source.whole());
    drape.grey = parse_grey_png(image.place(), document_.accessors.image(image));
    return drape;
  }

  void add_tracks(const GltfInstance& instance) {
    const auto noted = extra(instance.mesh, gltf_tracks_key);
    if (!noted) return;
    for (const JsonValue& primitive : instance.mesh.items("primitives")) {
      if (has_lines(primitive)) add_tracks(instance, primitive, *noted);
    }
  }

  void add_tracks(const GltfInstance& instance, const JsonValue& primitive,
                  const JsonValue& noted) {
    const TrackKind kind = kind_of(noted);
    std::vector<Vec3> points = gltf_points(document_, primitive, instance.to_scene);
    to_nm(points);
    std::vector<float> energies, materials;
    append_values(primitive, gltf_energy_attribute, energies);
    append_values(primitive, gltf_material_attribute, materials);
    const std::vector<double> counts = noted.numbers("points");
    constexpr std::array<const char*, 6> keys{"place",      "number",    "parent",
                                              "generation", "secondary", "electron"};
    std::array<std::vector<double>, keys.size()> lists;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      lists[k] = noted.numbers(keys[k]);
      if (lists[k].size() != counts.size()) noted.fail("its lists differ in length");
    }
    std::size_t first = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const auto size = whole<std::uint32_t>(counts[i], noted);
      const std::size_t most = std::min({points.size(), energies.size(), materials.size()}) - first;
      if (size < 2 || size > most)
        noted.fail(fmt::format("track {} cannot have {} points", i, size));
      Track track;
      track.kind = kind;
      track.number = whole<int>(lists[1][i], noted);
      track.parent = whole<int>(lists[2][i], noted);
      track.generation = whole<int>(lists[3][i], noted);
      track.secondary = lists[4][i] != 0;
      track.electron = whole<std::int64_t>(lists[5][i], noted);
      for (std::size_t p = first; p < first + size; ++p) {
        if (energies[p] < 0) primitive.fail(fmt::format("the energy at point {} is below 0", p));
        track.points_nm.push_back(points[p]);
        track.energy_ev.push_back(double{energies[p]});
        if (p > first) track.material.push_back(whole<int>(double{materials[p]}, primitive));
      }
      tracks_.emplace_back(lists[0][i], std::move(track));
      first += size;
    }
    if (first != points.size()) noted.fail("points are left over");
  }

  std::filesystem::path path_;
  GltfDocument document_;
  double unit_nm_;
  std::vector<GltfInstance> instances_;
  std::vector<std::pair<double, Track>> tracks_;  // by their place in what was written
};

/// Shapes alone, with their materials, in the file's unit.
ParsedFile parse_shapes(const MeshSource& source) {
  GltfDocument document(source.path, source.content);
  const std::vector<GltfInstance> instances = gltf_instances(document.root);
  check_gltf_size(document, instances);
  ParsedFile parsed;
  parsed.note.unit_nm = document.unit_nm;
  parsed.note.states_unit = true;
  for (const GltfBody& body : gltf_bodies(document, instances)) {
    ParsedBody shape{body.material, {.name = body.name, .mesh = {}}};
    for (const JsonValue& primitive : body.primitives)
      append_triangles(document, primitive, body.instance->to_scene, shape.surface.mesh);
    parsed.bodies.push_back(std::move(shape));
  }
  return parsed;
}

constexpr SurfaceFormat form_named(const char* extension) {
  return {.extension = extension,
          .several = true,
          .scalars = true,
          .drape = true,
          .tracks = true,
          .magnified = true};
}
constexpr std::array forms{form_named(".glb"), form_named(".gltf")};

}  // namespace

constinit const MeshFormat gltf_format{
    .forms = forms,
    .is = is_glb,
    .parse =
        [](const MeshSource& s) {
          return s.want == Want::shapes ? parse_shapes(s)
                                        : SceneParser(s.path, s.content, s.unit).parse();
        },
    .named_files = gltf_buffer_files,
    .format = write_gltf,
    .least = 0};

}  // namespace surf::io
