// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <utility>

#include "files/side_file.h"
#include "files/text_scanner.h"
#include "mesh_format.h"
#include "split_mesh.h"
#include "surf/core/error.h"
#include "text_output.h"

namespace surf::io {
namespace {

/// Statements without geometry that matters here.
bool is_ignored(std::string_view keyword) {
  static constexpr std::array<std::string_view, 21> ignored{
      "vn",  "vt",         "vp",        "l",      "p",     "g",        "s",
      "mg",  "mtllib",     "usemap",    "maplib", "bevel", "c_interp", "d_interp",
      "lod", "shadow_obj", "trace_obj", "call",   "csh",   "ctech",    "stech"};
  return std::find(ignored.begin(), ignored.end(), keyword) != ignored.end();
}

bool is_free_form(std::string_view keyword) {
  static constexpr std::array<std::string_view, 13> free_form{
      "cstype", "deg",  "bmat", "step", "curv", "curv2", "surf",
      "parm",   "trim", "hole", "scrv", "sp",   "con"};
  return std::find(free_form.begin(), free_form.end(), keyword) != free_form.end();
}

/// The vertex of a corner "7", "7/1", "7//3", "7/1/3", "-1": its index from 0. May point behind
/// the vertices read so far, as OBJ allows it; the caller checks at the end.
std::uint32_t corner(TextScanner& scanner, std::string_view word, std::size_t vertices) {
  std::int64_t number = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  const std::string_view rest(stop, static_cast<std::size_t>(end - stop));
  const bool rest_fits = rest.empty() || (rest[0] == '/' && rest.size() < 40 &&
                                          rest.find_first_not_of("/-0123456789") == rest.npos &&
                                          std::count(rest.begin(), rest.end(), '/') <= 2);
  if (error != std::errc{} || !rest_fits) {
    scanner.fail(fmt::format("'{}' is not a corner of a face", shown(word)));
  }
  const auto count = static_cast<std::int64_t>(vertices);
  const std::int64_t index = number > 0 ? number - 1 : count + number;
  if (number == 0 || index < 0 || index >= static_cast<std::int64_t>(max_mesh_vertices)) {
    scanner.fail(
        fmt::format("a face names vertex {}, and {} are defined so far", number, vertices));
  }
  return static_cast<std::uint32_t>(index);
}

class ObjParser {
 public:
  /// `by_object`: one part for each object, as semsurf writes surfaces, else for each material.
  ObjParser(const std::string& file, std::string_view content, bool by_object)
      : scanner_(file, content, {.comment = '#', .continuation = true}), by_object_(by_object) {}

  std::vector<ParsedBody> parse() {
    while (scanner_.next_filled_line()) statement(scanner_.word());
    if (highest_ >= mesh_.vertices_nm.size() && !mesh_.triangles.empty()) fail_at_highest();
    return parts();
  }

 private:
  /// A material, and the object that its faces lie in.
  struct Part {
    std::string material;
    std::string object;
    bool has_faces = false;
  };

  void statement(std::string_view keyword) {
    if (keyword == "v") {
      vertex();
    } else if (keyword == "f" || keyword == "fo") {
      face();
    } else if (keyword == "usemtl") {
      const std::string material = rest_of_line();
      if (!by_object_) use_material(material);
    } else if (keyword == "o") {
      object_ = rest_of_line();
      if (by_object_) begin_object();
    } else if (is_ignored(keyword)) {
      // Continued lines need the scanner's own idea of a line's end.
      while (!scanner_.at_line_end()) scanner_.word();
    } else if (is_free_form(keyword)) {
      scanner_.fail(fmt::format("'{}' belongs to a free-form surface", keyword),
                    "Export polygons: only they can be read");
    } else {
      scanner_.fail(fmt::format("'{}' is not an OBJ statement", shown(keyword)),
                    "Check that this is an OBJ file");
    }
  }

  void vertex() {
    const double x = scanner_.number("the x of a vertex");
    const double y = scanner_.number("the y of a vertex");
    const double z = scanner_.number("the z of a vertex");
    while (!scanner_.at_line_end()) scanner_.word();  // a weight or a colour
    mesh_.vertices_nm.push_back({x, y, z});
  }

  void face() {
    const std::size_t place = scanner_.position();
    corners_.clear();
    while (!scanner_.at_line_end()) {
      corners_.push_back(corner(scanner_, scanner_.word(), mesh_.vertices_nm.size()));
    }
    if (corners_.size() < 3) {
      scanner_.fail(fmt::format("a face has {} corners", corners_.size()),
                    "Remove it: a face needs three or more");
    }
    const std::uint32_t highest = *std::max_element(corners_.begin(), corners_.end());
    if (highest >= highest_) {
      highest_ = highest;
      highest_place_ = place;
    }
    add_fan(corners_, mesh_.triangles);
    part_of_triangle_.resize(mesh_.triangles.size(), current_);
    Part& part = parts_[current_];
    if (!part.has_faces) part.object = object_;
    if (part.object != object_) part.object.clear();  // faces of several objects
    part.has_faces = true;
  }

  std::string rest_of_line() {
    std::string text;
    while (!scanner_.at_line_end()) {
      if (!text.empty()) text += ' ';
      text += scanner_.word();
    }
    return text;
  }

  void use_material(const std::string& name) {
    const auto [entry, is_new] = numbers_.try_emplace(name, parts_.size());
    if (is_new) parts_.push_back({name, {}, false});
    current_ = static_cast<std::uint32_t>(entry->second);
  }

  void begin_object() {
    parts_.push_back({{}, object_, false});
    current_ = static_cast<std::uint32_t>(parts_.size() - 1);
  }

  std::vector<ParsedBody> parts() {
    const auto in_use = [](const Part& part) { return part.has_faces; };
    const auto used = std::count_if(parts_.begin(), parts_.end(), in_use);
    std::vector<ParsedBody> result;
    if (used == 1) {  // the vertices keep their order
      const Part& part = *std::find_if(parts_.begin(), parts_.end(), in_use);
      result.push_back({part.material, {.name = part.object, .mesh = std::move(mesh_)}});
      return result;
    }
    std::vector<TriangleMesh> meshes = split();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!parts_[i].has_faces) continue;
      result.push_back(
          {parts_[i].material, {.name = parts_[i].object, .mesh = std::move(meshes[i])}});
    }
    return result;
  }

  std::vector<TriangleMesh> split() const {
    if (!by_object_) return split_mesh(mesh_, part_of_triangle_, parts_.size());
    std::vector<TriangleMesh> meshes;
    for (MeshPart& part : split_in_order(mesh_, part_of_triangle_, parts_.size())) {
      meshes.push_back(std::move(part.mesh));
    }
    return meshes;
  }

  [[noreturn]] void fail_at_highest() {
    scanner_.go_to(highest_place_);
    scanner_.fail(fmt::format("a face names vertex {}, but the file has only {}",
                              std::uint64_t{highest_} + 1, mesh_.vertices_nm.size()));
  }

  TextScanner scanner_;
  bool by_object_;
  TriangleMesh mesh_;
  std::vector<std::uint32_t> corners_;
  std::string object_;
  std::vector<Part> parts_{Part{}};  // the first: faces before any material
  std::map<std::string, std::size_t> numbers_{{std::string{}, 0}};
  std::uint32_t current_ = 0;
  std::vector<std::uint32_t> part_of_triangle_;
  std::uint32_t highest_ = 0;
  std::size_t highest_place_ = 0;
};

/// The picture that the note names for a surface. It lies beside the file.
Drape find_drape(const std::filesystem::path& path, const std::string& name) {
  const std::filesystem::path picture(name);
  const auto found = side_file(path, picture);
  if (!found || picture.filename() != picture || name == ".") {
    throw FileError(path.string(),
                    fmt::format("its picture '{}' is not beside the file", shown(name)),
                    "Write the file again with semsurf");
  }
  const std::filesystem::path& place = *found;
  std::error_code error;
  if (!std::filesystem::exists(place, error)) {
    throw FileError(path.string(), fmt::format("its picture {} is missing", place.string()),
                    "Put it beside the file, or delete the line with 'surface:drape'");
  }
  return read_drape(place);
}

std::vector<OutputFile> format_obj(const std::filesystem::path& path, const SceneView& scene) {
  const std::string stem = path.stem().string();
  if (stem.find_first_of("\n\r") != stem.npos) {
    throw UsageError(path.string(), "OBJ cannot name a file whose name has line ends",
                     "Choose another name");
  }
  std::vector<OutputFile> files;
  SurfaceNote note = scene.note;
  std::string materials = "# written by semsurf\n";
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    if (!scene.surfaces[s].drape) continue;
    const std::string picture = fmt::format("{}_drape{}.png", stem, s + 1);
    materials += fmt::format("\nnewmtl drape{}\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {}\n",
                             s + 1, picture);
    note.drapes[s] = picture;
    files.push_back(
        {path.parent_path() / picture, format_drape(path.string(), *scene.surfaces[s].drape)});
  }
  std::string text = fmt::format(
      "# OBJ written by semsurf. Taken for millimetres, it shows the specimen {} times "
      "larger{}.\n{}",
      note.magnification,
      note.z_exaggeration == 1 ? ""
                               : fmt::format(", its heights another {} times", note.z_exaggeration),
      comments(note, true, "# "));
  if (!files.empty()) {
    text += fmt::format("mtllib {}.mtl\n", stem);
    files.push_back({path.parent_path() / (stem + ".mtl"), std::move(materials)});
  }
  std::uint64_t first = 1, first_texture = 1;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const SurfaceView& surface = scene.surfaces[s];
    const auto& places = surface.mesh->vertices_nm;
    text += fmt::format("o {}\n", plain_name(surface.name));
    for (const Vec3& v : places) add_vertex_line(text, note.to_file(v), "v ");
    if (!surface.drape) {
      for (const Triangle& t : surface.mesh->triangles) {
        fmt::format_to(std::back_inserter(text), "f {} {} {}\n", first + t[0], first + t[1],
                       first + t[2]);
      }
    } else {
      for (const Vec3& v : places) {
        const TexturePoint p = texture_point(*surface.drape, v);
        fmt::format_to(std::back_inserter(text), "vt {:.9g} {:.9g}\n", p.u, p.v);
      }
      text += fmt::format("usemtl drape{}\n", s + 1);
      for (const Triangle& t : surface.mesh->triangles) {
        fmt::format_to(std::back_inserter(text), "f {}/{} {}/{} {}/{}\n", first + t[0],
                       first_texture + t[0], first + t[1], first_texture + t[1], first + t[2],
                       first_texture + t[2]);
      }
      first_texture += places.size();
    }
    first += places.size();
  }
  files.push_back({path, std::move(text)});
  return files;
}

}  // namespace

ParsedFile parse_obj(const std::filesystem::path& path, std::string_view content, Want want) {
  ParsedFile parsed;
  apply_comments(content, '#', path.string(), parsed.note);
  parsed.bodies = ObjParser(path.string(), content, parsed.note.is_ours).parse();
  if (want == Want::shapes || !parsed.note.is_ours) return parsed;
  for (const auto& [place, picture] : parsed.note.drapes) {
    if (place >= parsed.bodies.size()) continue;
    parsed.bodies[place].surface.drape = find_drape(path, picture);
  }
  return parsed;
}

constexpr std::array obj_forms{
    SurfaceFormat{.extension = ".obj", .several = true, .drape = true, .magnified = true}};

constinit const MeshFormat obj_format{
    .forms = obj_forms,
    .parse = [](const MeshSource& s) { return parse_obj(s.path, s.content, s.want); },
    .format = format_obj};

}  // namespace surf::io
