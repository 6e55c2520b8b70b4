// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/scene_parts.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "sim/add_material.h"
#include "sim/field_source.h"
#include "sim/suggest.h"
#include "surf/core/field_words.h"
#include "surf/core/units.h"
#include "surf/io/mesh_file.h"
#include "surf/io/mesh_unit.h"
#include "surf/io/sim/materials.h"
#include "surf/io/sim/mesh_bodies.h"
#include "surf/io/sim/scene_keys.h"
#include "surf/mesh/shapes.h"

namespace surf::io {
namespace {

double required_length(const TomlTable& table, std::string_view key, std::string_view why) {
  table.require(key, why);
  return *table.length_nm(key);
}

int small_integer(const TomlTable& table, std::string_view key, int fallback) {
  const std::int64_t value = table.integer(key).value_or(fallback);
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    throw UsageError(table.place(key), fmt::format("{} is too large", value), "Give a smaller one");
  }
  return static_cast<int>(value);
}

[[noreturn]] void refuse_shape(const TomlTable& table, const std::string& shape,
                               std::vector<std::string> known) {
  const auto nearest = nearest_first(shape, std::move(known));
  throw UsageError(table.place("shape"), fmt::format("there is no shape '{}' here", shape),
                   fmt::format("Choose one of: {}", join(nearest)));
}

Edge read_edge(const TomlTable& table) {
  const std::string edge = table.text("edge").value_or("mirror");
  if (edge == "mirror") return Edge::mirror;
  if (edge == "flat") return Edge::flat;
  if (edge == "periodic") return Edge::periodic;
  throw UsageError(
      table.place("edge"), fmt::format("'{}' is not a way to go on", edge),
      fmt::format("Choose one of: {}", join(nearest_first(edge, {"mirror", "flat", "periodic"}))));
}

FieldExtent read_extent(const TomlTable& table) {
  FieldExtent extent;
  extent.width_nm = table.length_nm("width").value_or(extent.width_nm);
  extent.depth_nm = table.length_nm("depth").value_or(extent.width_nm);
  extent.pitch_nm = table.length_nm("pitch").value_or(extent.pitch_nm);
  return extent;
}

HeightField make_mesa_field(const TomlTable& table) {
  table.allow(keys_of("height_field", "mesa"));
  const double height = required_length(table, "height", "a mesa has one");
  const double top_width = required_length(table, "top_width", "a mesa has one");
  return make_mesa(read_extent(table), height, top_width, table.length_nm("wall_run").value_or(0));
}

HeightField make_trench_field(const TomlTable& table) {
  table.allow(keys_of("height_field", "trench"));
  const double depth = required_length(table, "trench_depth", "a trench has one");
  const double bottom = required_length(table, "bottom_width", "a trench has one");
  return make_trench(read_extent(table), depth, bottom, table.length_nm("wall_run").value_or(0));
}

HeightField make_line_field(const TomlTable& table) {
  table.allow(keys_of("height_field", "line"));
  const double height = required_length(table, "height", "a line has one");
  const double top_width = required_length(table, "top_width", "a line has one");
  return make_line(read_extent(table), height, top_width, table.length_nm("wall_run").value_or(0));
}

HeightField make_via_field(const TomlTable& table) {
  table.allow(keys_of("height_field", "via"));
  const double depth = required_length(table, "via_depth", "a via has one");
  const double bottom = required_length(table, "bottom_width", "a via has one");
  return make_via(read_extent(table), depth, bottom, table.length_nm("wall_run").value_or(0));
}

HeightField make_step_field(const TomlTable& table) {
  table.allow(keys_of("height_field", "step"));
  const double height = required_length(table, "height", "a step has one");
  return make_step(read_extent(table), height, table.length_nm("wall_run").value_or(0));
}

HeightField make_grating_field(const TomlTable& table) {
  table.allow(keys_of("height_field", "grating"));
  const double height = required_length(table, "height", "a grating has one");
  const double period = required_length(table, "period", "a grating has one");
  const double top_width = required_length(table, "top_width", "a grating has one");
  return make_grating(read_extent(table), height, period, top_width,
                      table.length_nm("wall_run").value_or(0));
}

HeightField make_rough_field(const TomlTable& table) {
  table.allow(keys_of("height_field", "rough"));
  const double rms = required_length(table, "rms", "a rough surface has one");
  const double correlation = required_length(table, "correlation", "a rough surface has one");
  const auto seed = static_cast<std::uint64_t>(table.integer("seed").value_or(1));
  if (const auto hurst = table.number("hurst")) {
    return make_self_affine(read_extent(table), rms, correlation, *hurst, seed);
  }
  return make_rough(read_extent(table), rms, correlation, seed);
}

HeightField make_field(const TomlTable& table) {
  const std::string shape = *table.text("shape");
  if (shape == "mesa") return make_mesa_field(table);
  if (shape == "trench") return make_trench_field(table);
  if (shape == "line") return make_line_field(table);
  if (shape == "via") return make_via_field(table);
  if (shape == "step") return make_step_field(table);
  if (shape == "grating") return make_grating_field(table);
  if (shape == "rough") return make_rough_field(table);
  refuse_shape(table, shape, {"mesa", "trench", "line", "via", "step", "grating", "rough"});
}

/// The nm of one unit of a height channel: "um", or a length such as "0.1nm".
double read_z_unit(const TomlTable& table) {
  const auto text = table.has("z_unit") ? table.text("z_unit") : std::nullopt;
  if (!text) return 1;
  const std::string place = table.place("z_unit");
  const bool has_number = text->find_first_of("0123456789") != std::string::npos;
  const double unit_nm = has_number ? parse_length_nm(*text, place) : unit_length_nm(*text, place);
  if (!(unit_nm > 0)) throw UsageError(place, "the unit is not above 0", "Give a positive length");
  return unit_nm;
}

MeshUnit read_unit(const TomlTable& table) {
  const auto text = table.text("unit");
  const bool overrides = table.flag("override_unit").value_or(false);
  if (text) return {unit_length_nm(*text, table.place("unit")), overrides};
  if (overrides)
    throw UsageError(table.place("override_unit"), "there is no unit to take",
                     "Add unit = \"um\", or leave it out");
  return {};
}

TriangleMesh make_body(const TomlTable& table) {
  const std::string shape = *table.text("shape");
  if (shape == "box") {
    table.allow(keys_of("body", "box"));
    table.require("lower", "a box has a lower corner");
    table.require("upper", "a box has an upper corner");
    return make_box(*table.point_nm("lower"), *table.point_nm("upper"),
                    small_integer(table, "subdivisions", 1));
  }
  if (shape == "sphere") {
    table.allow(keys_of("body", "sphere"));
    return make_sphere(table.point_nm("center").value_or(Vec3{}),
                       required_length(table, "radius", "a sphere has one"),
                       small_integer(table, "subdivisions", 4));
  }
  if (shape == "cone") {
    table.allow(keys_of("body", "cone"));
    return make_cone(table.point_nm("base").value_or(Vec3{}),
                     required_length(table, "bottom_radius", "a cone has one"),
                     table.length_nm("top_radius").value_or(0),
                     required_length(table, "height", "a cone has one"),
                     small_integer(table, "segments", 64));
  }
  refuse_shape(table, shape, {"box", "sphere", "cone"});
}

/// About x, y or z (axis 0, 1, 2), counter-clockwise seen from the axis's positive end. Quarter
/// turns are exact.
void rotate(TriangleMesh& mesh, int axis, double angle_deg) {
  const double turns = std::remainder(angle_deg, 360.0);
  double c = std::cos(turns * degrees_to_radians);
  double s = std::sin(turns * degrees_to_radians);
  if (std::fmod(turns, 90.0) == 0) {
    c = std::round(c);
    s = std::round(s);
  }
  for (Vec3& p : mesh.vertices_nm) {
    if (axis == 0) p = {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
    if (axis == 1) p = {s * p.z + c * p.x, p.y, c * p.z - s * p.x};
    if (axis == 2) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  }
}

void place_body(const TomlTable& table, TriangleMesh& mesh) {
  if (const auto factor = table.number("scale")) transform(mesh, *factor, {});
  for (const auto& [key, axis] : {std::pair{"rotate_x", 0}, {"rotate_y", 1}, {"rotate_z", 2}})
    if (const auto angle = table.angle_deg(key)) rotate(mesh, axis, *angle);
  if (const auto offset = table.point_nm("move")) transform(mesh, 1, *offset);
}

void require_one_source(const TomlTable& table, std::string_view file) {
  if (table.has(file) == table.has("shape")) {
    throw FileError(
        table.place(),
        fmt::format("it needs either '{}' or 'shape'{}", file, table.has(file) ? ", not both" : ""),
        table.has(file) ? "Remove one of them" : "Add one of them");
  }
}

}  // namespace

int SceneParts::material(const TomlTable& table) {
  table.require("material", "every solid has one");
  return add_material(scene_, *table.text("material"), table.place("material"));
}

std::filesystem::path SceneParts::input(const TomlTable& table, std::string_view key) {
  std::filesystem::path path = *table.text(key);
  if (path.empty()) throw UsageError(table.place(key), "the name is empty", "Name a file");
  if (path.is_relative()) path = folder_ / path;
  scene_.inputs.push_back(path);
  return path;
}

mc::Substrate SceneParts::read_substrate(const TomlTable& table) {
  table.allow(keys_of("substrate"));
  return {.material = material(table), .top_nm = table.length_nm("z").value_or(0)};
}

HeightField SceneParts::read_field_file(const TomlTable& table) {
  table.allow(keys_of("height_field", "file"));
  const double z_unit_nm = read_z_unit(table);
  const auto path = input(table, "file");
  const auto pixel = table.length_nm("pixel_size");
  if (pixel && !(*pixel > 0)) {
    throw UsageError(table.place("pixel_size"), "it is not above 0", "Give a positive length");
  }
  FieldSource source{path, {table.text("channel").value_or(""), {}, pixel, pixel}};
  if (table.has("z_unit")) source.options.z_unit_nm = z_unit_nm;
  return at_place(table, "channel",
                  [&] { return read_field(source, path.filename().string(), scene_.notes); });
}

mc::HeightFieldBody SceneParts::read_height_field(const TomlTable& table) {
  require_one_source(table, "file");
  mc::HeightFieldBody body;
  body.material = material(table);
  body.edge = read_edge(table);
  if (table.has("file")) {
    body.field = read_field_file(table);
    body.name = scene_.inputs.back().filename().string();
  } else {
    body.field = at_place(table, {}, [&] { return make_field(table); });
    body.name = *table.text("shape");
  }
  return body;
}

std::vector<mc::Body> SceneParts::read_mesh_file(const TomlTable& table) {
  table.allow(keys_of("body", "file"));
  const MeshUnit unit = read_unit(table);
  MaterialNames names{*table.text("material"), {}, table.place("materials")};
  if (const auto meaning = table.table("materials")) {
    for (const std::string& name : meaning->keys()) names.meaning[name] = *meaning->text(name);
  }
  const std::filesystem::path path = input(table, "mesh");
  std::vector<MeshBody> read = read_(path, unit, names, scene_.materials);
  if (unit.overrides_file) scene_.unit_overrides.push_back({path.filename().string(), *unit.nm});
  const std::vector<std::filesystem::path> files = mesh_input_files(path);
  scene_.inputs.insert(scene_.inputs.end(), files.begin() + 1, files.end());
  std::vector<mc::Body> bodies;
  for (MeshBody& part : read) {
    const std::string name = read.size() == 1 ? path.filename().string() : part.name;
    const auto given = table.text("name");
    bodies.push_back({!given             ? name
                      : read.size() == 1 ? *given
                                         : fmt::format("{}, {}", *given, name),
                      std::move(part.mesh),
                      add_material(scene_, part.material, table.place("material"))});
    scene_.unit_assumed = scene_.unit_assumed || part.unit_assumed;
  }
  return bodies;
}

std::vector<mc::Body> SceneParts::read_bodies(const TomlTable& table) {
  require_one_source(table, "mesh");
  std::vector<mc::Body> bodies;
  table.require("material", "every solid has one");
  scene_.materials.find(*table.text("material"),
                        table.place("material"));  // known, if not always used
  if (table.has("mesh")) {
    bodies = read_mesh_file(table);
  } else {
    bodies.push_back({table.text("name").value_or(*table.text("shape")),
                      at_place(table, {}, [&] { return make_body(table); }), material(table)});
  }
  for (mc::Body& body : bodies) {
    at_place(table, {}, [&] { place_body(table, body.mesh); });
  }
  return bodies;
}

std::string with_scene_words(std::string_view text) {
  return with_field_words(text, [](std::string_view field, std::string_view value) {
    return std::string(field) + (value.empty() ? "" : " = ") + std::string(value);
  });
}

void refuse_at(const TomlTable& table, std::string_view key, const UsageError& error) {
  const std::string reason = with_scene_words(error.reason()),
                    remedy = with_scene_words(error.remedy());
  std::string own;
  const std::string rest =
      with_field_words(error.subject(), [&](std::string_view field, std::string_view) {
        own = last_part(field, '_');
        return std::string();
      });
  if (rest.empty() && table.has(own)) throw UsageError(table.place(own), reason, remedy);
  throw UsageError(table.place(key), with_scene_words(error.subject()) + ": " + reason, remedy);
}

}  // namespace surf::io
