// SPDX-License-Identifier: GPL-3.0-or-later
// 3MF read: Core Specification 1.3, and parts in several files (Production Extension 1.1).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <utility>

#include "affine_map.h"
#include "file_unit.h"
#include "files/json_value.h"
#include "files/text_scanner.h"
#include "files/zip_file.h"
#include "mesh_format.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surface_names.h"
#include "three_mf_names.h"
#include "three_mf_write.h"

namespace surf::io {
namespace {

using pugi::xml_node;

/// Vertices and triangles in all that is to be built, copies included.
constexpr double max_size = double{1 << 28};

/// Without a namespace's prefix, which files choose as they like.
std::string_view local(std::string_view name) {
  const auto colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

xml_node child(const xml_node& node, std::string_view name) {
  return node.find_child([&](const xml_node& c) { return local(c.name()) == name; });
}

std::string_view attribute(const xml_node& node, std::string_view name) {
  return node.find_attribute([&](const pugi::xml_attribute& a) { return local(a.name()) == name; })
      .value();
}

/// What is to be built or put together: an object and how it lies.
struct Placed {
  std::string key;  ///< of the object: the model's part and its id
  AffineMap map;
};

/// A mesh, or other objects put together.
struct Object {
  std::string name;
  TriangleMesh mesh;  ///< in units of the file
  std::vector<Placed> components;
  double size = 1;  ///< of all that it shows: stops small files from filling the memory
};

class ThreeMfParser {
 public:
  ThreeMfParser(const std::filesystem::path& path, std::string_view content, const MeshUnit& unit)
      : path_(path), file_(path.string()), zip_(file_, content), given_unit_(unit) {}

  SurfaceScene parse() {
    const std::string part = model_part();
    pugi::xml_document document;
    const xml_node model = open(part, document);
    read_scale(model);
    read_objects(model, part, true);
    double size = 0;
    std::vector<Placed> items;
    const xml_node build = child(model, "build");
    for (const xml_node& item : build.children()) {
      if (local(item.name()) != "item") continue;
      items.push_back(placed(item, part, true));
      size += objects_.at(items.back().key).size;
      if (size > max_size)
        fail("build", "there are too many triangles, copies included", "Simplify the model");
    }
    for (const Placed& item : items) add(item);
    return std::move(scene_);
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& reason,
                         const std::string& remedy = "Export the file again") const {
    throw FileError(fmt::format("{}, {}", file_, place), reason, remedy);
  }

  std::string read_part(std::string_view name) const {
    if (name.starts_with('/')) name.remove_prefix(1);
    auto content = zip_.read(name);
    if (!content) fail("package", fmt::format("there is no part '{}'", shown(name)));
    return std::move(*content);
  }

  std::string model_part() const {
    pugi::xml_document document;
    const std::string relations = read_part("_rels/.rels");
    const auto result = document.load_buffer(relations.data(), relations.size());
    if (!result) fail("_rels/.rels", fmt::format("its XML is broken: {}", result.description()));
    for (const xml_node& relation : document.document_element().children()) {
      if (attribute(relation, "Type") == three_mf_model_relation)
        return std::string(attribute(relation, "Target"));
    }
    fail("_rels/.rels", "it names no model", "Export a 3MF file with a model");
  }

  xml_node open(const std::string& part, pugi::xml_document& document) const {
    const std::string content = read_part(part);
    const auto result = document.load_buffer(content.data(), content.size());
    if (!result) {
      fail(part,
           fmt::format("its XML is broken at byte {}: {}", result.offset, result.description()));
    }
    const xml_node model = document.document_element();
    if (local(model.name()) != "model") fail(part, "it is no model");
    check_extensions(model, part);
    return model;
  }

  /// Those that add looks, or files, change no shapes.
  void check_extensions(const xml_node& model, const std::string& part) const {
    std::string_view rest = attribute(model, "requiredextensions");
    while (!rest.empty()) {
      const auto blank = std::min(rest.find(' '), rest.size());
      const std::string prefix(rest.substr(0, blank));
      rest.remove_prefix(std::min(blank + 1, rest.size()));
      if (prefix.empty()) continue;
      std::string_view space = model.attribute(("xmlns:" + prefix).c_str()).value();
      const bool is_known =
          space.find("/material/") != space.npos || space.find("/production/") != space.npos;
      if (is_known) continue;
      constexpr std::string_view usual = "http://schemas.microsoft.com/3dmanufacturing/";
      if (space.starts_with(usual)) space.remove_prefix(usual.size());
      throw Unsupported(fmt::format("{}, {}", file_, part),
                        fmt::format("it requires the extension '{}', which is not read here",
                                    shown(space.empty() ? std::string_view(prefix) : space)),
                        "Export plain meshes");
    }
  }

  void read_scale(const xml_node& model) {
    std::string_view name = attribute(model, "unit");
    if (name.empty()) name = "millimeter";
    const auto unit = std::find_if(three_mf_units.begin(), three_mf_units.end(),
                                   [&](const ThreeMfUnit& u) { return u.name == name; });
    if (unit == three_mf_units.end())
      fail("model", fmt::format("the unit '{}' is not known", shown(name)));
    double magnification = 1;
    for (const xml_node& node : model.children()) {
      if (local(node.name()) != "metadata") continue;
      const std::string_view key = node.attribute("name").value();
      const std::string value = node.text().get();
      if (key == three_mf_magnification) magnification = positive(value, three_mf_magnification);
      if (key == three_mf_exaggeration) z_exaggeration_ = positive(value, three_mf_exaggeration);
      if (key == three_mf_metadata) {
        const JsonValue object =
            JsonValue::parse(fmt::format("{}, {}", file_, key), "{\"metadata\":" + value + "}");
        scene_.metadata = object.texts("metadata");
      }
    }
    unit_nm_ = file_unit_nm(given_unit_, unit->nm / magnification, file_);
  }

  double positive(std::string_view text, const char* place) const {
    const double value = number(text, place);
    if (!(value > 0)) fail(place, "a number above 0 is expected");
    return value;
  }

  double number(std::string_view text, const char* place) const {
    while (!text.empty() && (text.front() == ' ' || text.front() == '+')) text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    // What lies below the smallest number is 0.
    const bool is_tiny = error == std::errc::result_out_of_range && std::abs(value) < 1;
    if ((error != std::errc{} && !is_tiny) || end != text.data() + text.size() ||
        !std::isfinite(value)) {
      fail(place, fmt::format("'{}' is not a number", shown(text)));
    }
    return value;
  }

  std::uint32_t index(std::string_view text, std::size_t vertices, const std::string& place) const {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value >= vertices) {
      fail(place, fmt::format("'{}' is not one of the {} vertices", shown(text), vertices));
    }
    return value;
  }

  void read_objects(const xml_node& model, const std::string& part, bool is_root) {
    const xml_node resources = child(model, "resources");
    for (const xml_node& node : resources.children()) {
      if (local(node.name()) != "object") continue;
      const std::string key = key_of(part, attribute(node, "id"));
      const std::string place = fmt::format("object {}", shown(attribute(node, "id")));
      Object object;
      object.name = attribute(node, "name");
      if (const xml_node mesh = child(node, "mesh")) read_mesh(mesh, place, object);
      // Objects that come later cannot be named, so that none is part of itself.
      const xml_node components = child(node, "components");
      for (const xml_node& component : components.children()) {
        if (local(component.name()) != "component") continue;
        object.components.push_back(placed(component, part, is_root));
        object.size += objects_.at(object.components.back().key).size;
      }
      if (!objects_.emplace(key, std::move(object)).second)
        fail(place, "its number is that of another object");
    }
  }

  void read_mesh(const xml_node& node, const std::string& place, Object& object) const {
    const xml_node vertices = child(node, "vertices"), triangles = child(node, "triangles");
    for (const xml_node& v : vertices.children()) {
      if (local(v.name()) != "vertex") continue;
      object.mesh.vertices_nm.push_back({number(v.attribute("x").value(), "x of a vertex"),
                                         number(v.attribute("y").value(), "y of a vertex"),
                                         number(v.attribute("z").value(), "z of a vertex")});
    }
    const std::size_t count = object.mesh.vertices_nm.size();
    for (const xml_node& t : triangles.children()) {
      if (local(t.name()) != "triangle") continue;
      object.mesh.triangles.push_back({index(t.attribute("v1").value(), count, place),
                                       index(t.attribute("v2").value(), count, place),
                                       index(t.attribute("v3").value(), count, place)});
    }
    object.size += static_cast<double>(count + object.mesh.triangles.size());
  }

  static std::string key_of(std::string_view part, std::string_view id) {
    if (part.starts_with('/')) part.remove_prefix(1);
    return fmt::format("{}#{}", part, id);
  }

  /// An item or component. Only those of the root may lie in other parts of the package.
  Placed placed(const xml_node& node, const std::string& part, bool is_root) {
    const std::string other(attribute(node, "path"));
    const std::string& owner = other.empty() ? part : other;
    if (!other.empty() && is_root && parts_.insert(other).second &&
        key_of(other, "") != key_of(part, "")) {
      pugi::xml_document document;
      read_objects(open(other, document), other, false);
    }
    Placed result{key_of(owner, attribute(node, "objectid")), transform_of(node)};
    if (objects_.count(result.key) == 0) {
      fail(node.name(),
           fmt::format("there is no object '{}' before it", shown(attribute(node, "objectid"))));
    }
    return result;
  }

  /// Three rows that x, y and z are multiplied with, and the offset (3.3).
  AffineMap transform_of(const xml_node& node) const {
    std::string_view text = attribute(node, "transform");
    if (text.empty()) return {};
    std::array<double, 12> m{};
    for (double& value : m) {
      text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
      const auto end = std::min(text.find_first_of(" \t\r\n"), text.size());
      value = number(text.substr(0, end), "transform");
      text.remove_prefix(end);
    }
    return {{Vec3{m[0], m[1], m[2]}, Vec3{m[3], m[4], m[5]}, Vec3{m[6], m[7], m[8]},
             Vec3{m[9], m[10], m[11]}}};
  }

  /// A surface for each mesh in the object, from the first to the last.
  void add(const Placed& item) {
    std::vector<Placed> waiting{item};  // the next one is the last
    while (!waiting.empty()) {
      const Placed next = std::move(waiting.back());
      waiting.pop_back();
      const Object& object = objects_.at(next.key);
      if (!object.mesh.triangles.empty()) add_surface(object, next.map);
      for (auto c = object.components.rbegin(); c != object.components.rend(); ++c) {
        waiting.push_back({c->key, product(next.map, c->map)});
      }
    }
  }

  void add_surface(const Object& object, const AffineMap& map) {
    Surface surface;
    surface.name = unique_(object.name.empty() ? path_.stem().string() : object.name);
    surface.mesh = object.mesh;
    for (Vec3& v : surface.mesh.vertices_nm) {
      const Vec3 p = map(v) * unit_nm_;
      v = {p.x, p.y, p.z / z_exaggeration_};
      if (is_finite(v)) continue;
      throw FileError(
          file_,
          fmt::format("its coordinates are too large for a unit of {} nm", format_exact(unit_nm_)),
          "Check the unit");
    }
    if (map.mirrors()) {
      for (Triangle& t : surface.mesh.triangles) std::swap(t[1], t[2]);
    }
    scene_.surfaces.push_back(std::move(surface));
  }

  std::filesystem::path path_;
  std::string file_;
  ZipReader zip_;
  MeshUnit given_unit_;
  double unit_nm_ = 1;
  double z_exaggeration_ = 1;
  std::map<std::string, Object> objects_;
  std::set<std::string> parts_;
  UniqueNames unique_;
  SurfaceScene scene_;
};

}  // namespace

bool is_3mf(std::string_view content) {
  if (!content.starts_with("PK\3\4")) return false;
  try {
    for (const std::string& name : ZipReader({}, content).names()) {
      if (name.ends_with(".model")) return true;
    }
  } catch (const Error&) {
  }
  return content.substr(0, 4096).find("3D/") != content.npos;  // damaged: the reader says how
}

constexpr std::array three_mf_forms{
    SurfaceFormat{.extension = ".3mf", .several = true, .magnified = true}};

constinit const MeshFormat three_mf_format{
    .forms = three_mf_forms,
    .is = is_3mf,
    .parse =
        [](const MeshSource& source) {
          SurfaceScene scene = ThreeMfParser(source.path, source.content, source.unit).parse();
          ParsedFile parsed;
          for (Surface& surface : scene.surfaces) parsed.bodies.push_back({{}, std::move(surface)});
          parsed.note.metadata = std::move(scene.metadata);
          parsed.is_in_nm = true;
          return parsed;
        },
    .format =
        [](const std::filesystem::path& path, const SceneView& scene) {
          return one_file(path, write_3mf(path.string(), scene));
        },
    .least = 0};

}  // namespace surf::io
