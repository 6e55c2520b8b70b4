// SPDX-License-Identifier: GPL-3.0-or-later
// glTF 2.0 and GLB. The only source that knows tinygltf, which makes the text; the binary part,
// which can be large, is made here once.
#include "write_gltf.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "bytes.h"
#include "camera.h"
#include "files/lower_extension.h"
#include "files/percent_encoded.h"
#include "files/plain_text.h"
#include "names.h"
#include "raster/image_formats.h"
#include "surf/core/error.h"
#include "surf/mesh/vertex_normals.h"

namespace surf::io {
namespace {

using tinygltf::Value;
using Object = Value::Object;
using Array = Value::Array;

constexpr double metre_nm = 1e9;

/// Matte; the first surface grey, others tinted, so that they can be told apart. Linear, not sRGB.
constexpr std::array<std::array<double, 3>, 6> surface_colors{{{0.52, 0.52, 0.52},
                                                               {0.35, 0.48, 0.60},
                                                               {0.60, 0.46, 0.32},
                                                               {0.38, 0.55, 0.38},
                                                               {0.55, 0.38, 0.50},
                                                               {0.55, 0.53, 0.30}}};

/// Emitted, so that lines are seen without lights: absorbed, se, bse, transmitted, lost.
constexpr std::array<std::array<double, 3>, 5> track_colors{{{0.10, 0.25, 0.80},
                                                             {0.90, 0.60, 0.05},
                                                             {0.80, 0.08, 0.05},
                                                             {0.10, 0.60, 0.25},
                                                             {0.45, 0.45, 0.45}}};

/// "_HEIGHT_NM"; units that are no plain word are left to the extras.
std::string attribute_name(const VertexScalar& scalar) {
  const auto upper = [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  };
  const auto is_word = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  std::string name = "_" + scalar.name;
  if (!scalar.unit.empty() && std::all_of(scalar.unit.begin(), scalar.unit.end(), is_word)) {
    name += "_" + scalar.unit;
  }
  std::transform(name.begin(), name.end(), name.begin(), upper);
  return name;
}

class GltfBuilder {
 public:
  GltfBuilder(const std::filesystem::path& path, const SceneView& scene)
      : path_(path), file_(path.string()), scene_(scene),
        scale_(scene.note.magnification / metre_nm), exaggeration_(scene.note.z_exaggeration),
        is_glb_(lower_extension(path) == ".glb") {
    model_.asset.version = "2.0";
    const auto version = scene.note.metadata.find("semsurf.version");
    model_.asset.generator =
        version == scene.note.metadata.end() ? "semsurf" : "semsurf " + version->second;
    model_.asset.extras = Value(Object{{gltf_own_key, own_extras()}});
  }

  std::vector<OutputFile> build() {
    bytes_.reserve(expected_size());
    tinygltf::Node root;
    root.name = "nm to m, y up";
    root.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // (x, y, z) -> (x, z, -y)
    root.scale = {scale_, scale_, scale_ * exaggeration_};
    model_.nodes.push_back(root);
    for (const SurfaceView& surface : scene_.surfaces) add(surface);
    for (const TrackKind kind : {TrackKind::absorbed, TrackKind::se, TrackKind::bse,
                                 TrackKind::transmitted, TrackKind::lost}) {
      add_tracks(kind);
    }
    add_camera();
    return pack();
  }

 private:
  Value own_extras() const {
    Object metadata;
    for (const auto& [key, value] : scene_.note.metadata) {
      check_plain_text(key, "a name in the metadata", file_);
      metadata[key] = Value(as_plain_text(value));
    }
    Object own{{gltf_unit_key, Value(std::string("nm"))},
               {gltf_magnification_key, Value(scene_.note.magnification)},
               {gltf_exaggeration_key, Value(exaggeration_)}};
    if (!metadata.empty()) own[gltf_metadata_key] = Value(metadata);  // tinygltf writes null for {}
    return Value(own);
  }

  std::size_t expected_size() const {
    std::size_t bytes = std::size_t{1} << 16;  // also for the text before it
    for (const SurfaceView& surface : scene_.surfaces) {
      bytes += surface.mesh->vertices_nm.size() *
                   (24 + 4 * surface.scalars.size() + (surface.drape ? 8 : 0)) +
               surface.mesh->triangles.size() * 12;
      if (surface.drape) bytes += surface.drape->grey.size();
    }
    for (const Track& track : scene_.tracks) bytes += track.points_nm.size() * 28 + 64;
    return bytes;
  }

  int add_view(const GltfBytes::Stretch& stretch, int target = 0) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = stretch.offset;
    view.byteLength = stretch.bytes;
    view.target = target;
    model_.bufferViews.push_back(view);
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }

  int add_accessor(const GltfBytes::Stretch& stretch, int target, int component, int type,
                   std::size_t count) {
    tinygltf::Accessor accessor;
    accessor.bufferView = add_view(stretch, target);
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    model_.accessors.push_back(accessor);
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  int add_floats(const std::vector<float>& values, int type, std::size_t components) {
    return add_accessor(bytes_.add(values), TINYGLTF_TARGET_ARRAY_BUFFER,
                        TINYGLTF_COMPONENT_TYPE_FLOAT, type, values.size() / components);
  }

  /// Offsets from `center`, with the bounds that the format demands of positions.
  int add_positions(const std::vector<Vec3>& points_nm, const Vec3& center,
                    const std::string& owner) {
    std::vector<float> values;
    values.reserve(3 * points_nm.size());
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (const Vec3& p : points_nm) {
      const std::array<double, 3> offset{p.x - center.x, p.y - center.y, p.z - center.z};
      for (std::size_t c = 0; c < 3; ++c) {
        const auto value = static_cast<float>(offset[c]);
        if (!std::isfinite(value)) refuse_size(owner);
        low[c] = std::min(low[c], value);
        high[c] = std::max(high[c], value);
        values.push_back(value);
      }
    }
    const int accessor = add_floats(values, TINYGLTF_TYPE_VEC3, 3);
    model_.accessors.back().minValues.assign(low.begin(), low.end());
    model_.accessors.back().maxValues.assign(high.begin(), high.end());
    return accessor;
  }

  [[noreturn]] void refuse_size(const std::string& owner) const {
    throw InvalidInput(file_, fmt::format("{} is too large for the 32-bit numbers of glTF", owner),
                       "Check its unit");
  }

  /// 16 bits where they do: their highest number is kept back by the format (3.7.2.1).
  template <class Corners>
  int add_indices(const Corners& corners, std::size_t vertices) {
    if (vertices <= 65535) {
      const std::vector<std::uint16_t> small(corners.begin(), corners.end());
      return add_accessor(bytes_.add(small), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                          TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR,
                          small.size());
    }
    return add_accessor(bytes_.add(std::span<const std::uint32_t>(corners)),
                        TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                        TINYGLTF_TYPE_SCALAR, corners.size());
  }

  int add_normals(const TriangleMesh& mesh) {
    std::vector<float> values;
    values.reserve(3 * mesh.vertices_nm.size());
    for (const Vec3& n : vertex_normals(mesh)) {
      for (const double c : {n.x, n.y, n.z}) values.push_back(static_cast<float>(c));
    }
    return add_floats(values, TINYGLTF_TYPE_VEC3, 3);
  }

  /// (0, 0) is the upper left corner of the picture.
  int add_places(const TriangleMesh& mesh, const Drape& drape) {
    std::vector<float> values;
    values.reserve(2 * mesh.vertices_nm.size());
    for (const Vec3& v : mesh.vertices_nm) {
      values.push_back(static_cast<float>(((v.x - drape.origin_x_nm) / drape.pitch_x_nm + 0.5) /
                                          drape.grey.width()));
      values.push_back(static_cast<float>(1 - ((v.y - drape.origin_y_nm) / drape.pitch_y_nm + 0.5) /
                                                  drape.grey.height()));
      if (std::isfinite(values.back()) && std::isfinite(values[values.size() - 2])) continue;
      throw InvalidInput(file_,
                         fmt::format("the picture '{}' lies too far from its surface", drape.name),
                         "Check the pixel size and the origin of both");
    }
    return add_floats(values, TINYGLTF_TYPE_VEC2, 2);
  }

  void add(const SurfaceView& surface) {
    const std::string owner = fmt::format("the surface '{}'", surface.name);
    const Box box = bounds(*surface.mesh);
    const Vec3 center = center_of(box, owner);
    box_nm_.extend(box);
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes["POSITION"] = add_positions(surface.mesh->vertices_nm, center, owner);
    primitive.attributes["NORMAL"] = add_normals(*surface.mesh);
    if (surface.drape)
      primitive.attributes["TEXCOORD_0"] = add_places(*surface.mesh, *surface.drape);
    Object extras;
    Array scalars;
    for (const VertexScalar& scalar : surface.scalars) {
      check_plain_text(scalar.unit, fmt::format("the unit of '{}'", scalar.name), file_);
      std::string attribute = attribute_name(scalar);
      while (primitive.attributes.count(attribute) > 0) attribute += "_";
      primitive.attributes[attribute] = add_floats(scalar.values, TINYGLTF_TYPE_SCALAR, 1);
      scalars.push_back(Value(Object{{"attribute", Value(attribute)},
                                     {"name", Value(as_plain_text(scalar.name))},
                                     {"unit", Value(scalar.unit)}}));
    }
    if (!scalars.empty()) extras[gltf_scalars_key] = Value(scalars);
    if (surface.drape) extras[gltf_drape_key] = drape_extras(*surface.drape);
    const std::span<const std::uint32_t> corners(surface.mesh->triangles.front().data(),
                                                 3 * surface.mesh->triangles.size());
    primitive.indices = add_indices(corners, surface.mesh->vertices_nm.size());
    primitive.material = surface.drape ? add_draped_material(*surface.drape) : add_plain_material();
    add_node(as_plain_text(surface.name), center, primitive, extras);
  }

  static Vec3 scaled(const Vec3& p, double factor, double exaggeration) {
    return {p.x * factor, p.y * factor, p.z * factor * exaggeration};
  }

  Vec3 center_of(const Box& box, const std::string& owner) const {
    const Vec3 center = box.lower_nm * 0.5 + box.upper_nm * 0.5;
    const Vec3 far = scaled(box.upper_nm - box.lower_nm, 1, 1);
    constexpr double most = std::numeric_limits<float>::max();
    for (const double c : {center.x, center.y, center.z, far.x, far.y, far.z}) {
      if (!(std::abs(c) <= most) ||
          !(std::abs(c) * scale_ * std::max(1.0, exaggeration_) <= most)) {
        refuse_size(owner);
      }
    }
    return center;
  }

  void add_node(const std::string& name, const Vec3& center, const tinygltf::Primitive& primitive,
                const Object& extras) {
    tinygltf::Mesh mesh;
    mesh.name = name;
    mesh.primitives = {primitive};
    if (!extras.empty()) mesh.extras = Value(extras);
    model_.meshes.push_back(mesh);
    tinygltf::Node node;
    node.name = name;
    node.mesh = static_cast<int>(model_.meshes.size()) - 1;
    if (center != Vec3{}) node.translation = {center.x, center.y, center.z};
    model_.nodes.push_back(node);
    model_.nodes.front().children.push_back(static_cast<int>(model_.nodes.size()) - 1);
  }

  static tinygltf::Material matte(const std::array<double, 3>& color) {
    tinygltf::Material material;
    material.doubleSided = true;
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.8;
    material.pbrMetallicRoughness.baseColorFactor = {color[0], color[1], color[2], 1};
    return material;
  }

  int add_material(const tinygltf::Material& material) {
    model_.materials.push_back(material);
    return static_cast<int>(model_.materials.size()) - 1;
  }

  int add_plain_material() {
    return add_material(matte(surface_colors[surfaces_++ % surface_colors.size()]));
  }

  int add_draped_material(const Drape& drape) {
    tinygltf::Image image;
    image.name = as_plain_text(drape.name);
    std::string png = format_grey_png(file_, drape.grey);
    if (is_glb_) {
      image.bufferView = add_view(bytes_.add(png));
      image.mimeType = "image/png";
    } else {
      // Not NAME.png, which may be the picture that is draped.
      const auto name =
          fmt::format("{}_drape{}.png", path_.stem().string(), model_.images.size() + 1);
      image.uri = percent_encoded(name);
      files_.push_back({path_.parent_path() / name, std::move(png)});
    }
    model_.images.push_back(image);
    if (model_.samplers.empty()) {
      tinygltf::Sampler sampler;
      sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
      sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
      sampler.wrapS = sampler.wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
      model_.samplers.push_back(sampler);
    }
    tinygltf::Texture texture;
    texture.sampler = 0;
    texture.source = static_cast<int>(model_.images.size()) - 1;
    model_.textures.push_back(texture);
    tinygltf::Material material = matte({1, 1, 1});
    material.pbrMetallicRoughness.baseColorTexture.index =
        static_cast<int>(model_.textures.size()) - 1;
    return add_material(material);
  }

  Value drape_extras(const Drape& drape) const {
    return Value(Object{{"name", Value(as_plain_text(drape.name))},
                        {"pitch_x_nm", Value(drape.pitch_x_nm)},
                        {"pitch_y_nm", Value(drape.pitch_y_nm)},
                        {"origin_x_nm", Value(drape.origin_x_nm)},
                        {"origin_y_nm", Value(drape.origin_y_nm)}});
  }

  /// All tracks of a kind as one set of lines, with what is known of each track in the extras.
  void add_tracks(TrackKind kind) {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> ends;
    std::vector<float> energies, materials;
    std::map<std::string, Array> lists;
    for (std::size_t i = 0; i < scene_.tracks.size(); ++i) {
      const Track& track = scene_.tracks[i];
      if (track.kind != kind) continue;
      for (std::size_t p = 0; p < track.points_nm.size(); ++p) {
        const auto index = static_cast<std::uint32_t>(points.size());
        if (p > 0) ends.insert(ends.end(), {index - 1, index});
        points.push_back(track.points_nm[p]);
        energies.push_back(static_cast<float>(track.energy_ev[p]));
        if (!std::isfinite(energies.back())) refuse_size("the energy of a track");
        materials.push_back(static_cast<float>(track.material[p == 0 ? 0 : p - 1]));
      }
      const auto add = [&](const char* key, auto value) {
        lists[key].push_back(Value(double(value)));
      };
      add("place", i);
      add("points", track.points_nm.size());
      add("number", track.number);
      add("parent", track.parent);
      add("generation", track.generation);
      add("secondary", track.secondary ? 1 : 0);
      add("electron", track.electron);
    }
    if (points.empty()) return;
    const std::string name = fmt::format("tracks, {}", name_of(kind));
    Box box;
    for (const Vec3& p : points) box.extend(p);
    const Vec3 center = center_of(box, name);
    tracks_box_nm_.extend(box);
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_LINE;
    primitive.attributes["POSITION"] = add_positions(points, center, name);
    primitive.attributes[gltf_energy_attribute] = add_floats(energies, TINYGLTF_TYPE_SCALAR, 1);
    primitive.attributes[gltf_material_attribute] = add_floats(materials, TINYGLTF_TYPE_SCALAR, 1);
    primitive.indices = add_indices(ends, points.size());
    const auto& color = track_colors[static_cast<std::size_t>(kind)];
    tinygltf::Material material = matte(color);  // three.js draws lines in the base colour, unlit
    material.emissiveFactor.assign(color.begin(), color.end());
    primitive.material = add_material(material);
    Object tracks{{"kind", Value(std::string(name_of(kind)))}};
    for (auto& [key, list] : lists) tracks[key] = Value(std::move(list));
    add_node(name, center, primitive, {{gltf_tracks_key, Value(tracks)}});
  }

  /// A box in nm as it lies in the scene: in metres, y up.
  Box in_scene(const Box& box_nm) const {
    Box box;
    for (const Vec3& p : {box_nm.lower_nm, box_nm.upper_nm}) {
      const Vec3 q = scaled(p, scale_, exaggeration_);
      box.extend(Vec3{q.x, q.z, -q.y});
    }
    return box;
  }

  void add_camera() {
    Box all_nm = box_nm_;
    all_nm.extend(tracks_box_nm_);
    const GltfCamera view = frame_box(in_scene(box_nm_), in_scene(all_nm), scale_);
    tinygltf::Camera camera;
    camera.type = "perspective";
    camera.name = "oblique";
    camera.perspective.yfov = view.yfov;
    camera.perspective.znear = view.znear;
    camera.perspective.zfar = view.zfar;
    model_.cameras.push_back(camera);
    tinygltf::Node node;
    node.name = "camera";
    node.camera = 0;
    node.translation = {view.position.x, view.position.y, view.position.z};
    node.rotation.assign(view.rotation.begin(), view.rotation.end());
    model_.nodes.push_back(node);
    tinygltf::Scene scene;
    scene.nodes = {0, static_cast<int>(model_.nodes.size()) - 1};
    model_.scenes.push_back(scene);
    model_.defaultScene = 0;
  }

  std::vector<OutputFile> pack() {
    tinygltf::TinyGLTF writer;
    writer.SetImageWriter(nullptr, nullptr);  // the pictures are made already
    std::ostringstream text;
    if (!writer.WriteGltfSceneToStream(&model_, text, false, false)) {
      throw FileError(file_, "tinygltf could not make its text",
                      "Report this as a fault of semsurf");
    }
    nlohmann::json json = nlohmann::json::parse(std::move(text).str());
    json["buffers"] = {{{"byteLength", bytes_.size()}}};
    if (is_glb_) return {{path_, format_glb(file_, json.dump(), bytes_.take())}};
    const std::string name = path_.stem().string() + ".bin";
    json["buffers"][0]["uri"] = percent_encoded(name);
    files_.push_back({path_.parent_path() / name, bytes_.take()});
    files_.push_back({path_, json.dump(1)});
    return std::move(files_);
  }

  std::filesystem::path path_;
  std::string file_;
  const SceneView& scene_;
  double scale_;  ///< metres of the file's body per nm
  double exaggeration_;
  bool is_glb_;
  tinygltf::Model model_;
  GltfBytes bytes_;
  std::vector<OutputFile> files_;
  Box box_nm_, tracks_box_nm_;
  std::size_t surfaces_ = 0;
};

}  // namespace

std::vector<OutputFile> write_gltf(const std::filesystem::path& path, const SceneView& scene) {
  return GltfBuilder(path, scene).build();
}

}  // namespace surf::io
