// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/describe_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "surf/core/error.h"
#include "surf/core/parameters.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/model/model_file.h"
#include "surf/io/sem_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/io/surface_file.h"
#include "surf/mesh/check_mesh.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {
namespace {

using Json = nlohmann::ordered_json;

/// Lowest, highest and mean of what is finite and counts.
class Range {
 public:
  void add(double value) {
    if (!std::isfinite(value)) {
      ++not_finite_;
      return;
    }
    lowest_ = std::min(lowest_, value), highest_ = std::max(highest_, value);
    sum_ += value, ++count_;
  }
  void put(Json& out, const char* unit = "") const {
    const auto name = [&](const char* what) { return std::string(what) + unit; };
    const bool any = count_ > 0;
    out[name("lowest")] = any ? Json(lowest_) : Json();
    out[name("highest")] = any ? Json(highest_) : Json();
    out[name("mean")] = any ? Json(sum_ / double(count_)) : Json();
  }
  std::size_t not_finite() const { return not_finite_; }

 private:
  double lowest_ = HUGE_VAL, highest_ = -HUGE_VAL, sum_ = 0;
  std::size_t count_ = 0, not_finite_ = 0;
};

Json point(const Vec3& v) { return {v.x, v.y, v.z}; }

Json box(const Box& b) { return {{"lower", point(b.lower_nm)}, {"upper", point(b.upper_nm)}}; }

template <class Texts>
void put_metadata(Json& out, const Texts& metadata) {
  Json all = Json::object();
  for (const auto& [key, value] : metadata) all[key] = value;
  out["metadata"] = std::move(all);
}

template <class Grid>
void put_size(Json& out, const Grid& grid, double pitch_x_nm, double pitch_y_nm) {
  out["width"] = grid.width(), out["height"] = grid.height();
  out["pitch_x_nm"] = pitch_x_nm, out["pitch_y_nm"] = pitch_y_nm;
}

Json heights(const std::filesystem::path& path) {
  const io::HeightFile file(path);
  const io::HeightFieldFile first = file.read();
  Json out{{"format", first.format}};
  put_size(out, first.field.z_nm, first.field.pitch_x_nm, first.field.pitch_y_nm);
  Json channels = Json::array();
  std::size_t number = 0;
  for (const io::HeightChannel& channel : file.channels()) {
    Json one{{"name", channel.name},
             {"is_height", channel.is_height},
             {"unit", channel.z_unit},
             {"width", channel.width},
             {"height", channel.height}};
    ++number;
    if (channel.is_height) try {
        const HeightField field = file.read({std::to_string(number), {}, {}, {}}).field;
        Range range;
        std::size_t holes = 0;
        for (int y = 0; y < field.z_nm.height(); ++y)
          for (int x = 0; x < field.z_nm.width(); ++x)
            if (field.is_valid(x, y)) range.add(field.z_nm(x, y));
            else ++holes;
        range.put(one, "_nm");
        one["holes"] = holes;
      } catch (const Error& error) {
        one["error"] = error.reason();
      }
    channels.push_back(std::move(one));
  }
  out["channels"] = std::move(channels);
  out["notes"] = first.notes;
  put_metadata(out, first.metadata);
  return out;
}

template <class Number>
Json optional(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

Json sem_image(const std::filesystem::path& path) {
  const io::SemFile file = io::read_sem_image(path);
  Json out{{"format", file.format}, {"instrument", file.instrument}};
  put_size(out, file.image.values, file.image.pitch_x_nm, file.image.pitch_y_nm);
  out["pixel_from"] = file.pixel_from;
  out["databar_rows"] = file.databar_rows;
  out["bits"] = file.bits;
  Range range;
  for (std::size_t i = 0; i < file.image.values.size(); ++i)
    if (file.image.valid.empty() || file.image.valid.data()[i])
      range.add(file.image.values.data()[i]);
  range.put(out);
  out["energy_ev"] = optional(file.energy_ev);
  out["working_distance_nm"] = optional(file.working_distance_nm);
  out["tilt_deg"] = optional(file.tilt_deg);
  out["detector"] = file.detector;
  out["notes"] = file.notes;
  put_metadata(out, file.metadata);
  return out;
}

Json image(const std::filesystem::path& path) {
  constexpr std::int64_t most_pixels = std::int64_t{1} << 25;
  const io::ImageLevel read = io::read_image_within(path, most_pixels);
  const double scale = std::ldexp(1.0, read.level);
  const bool placed = io::states_pixel_size(read.image);
  Json out{{"width", read.whole.width}, {"height", read.whole.height}};
  out["pitch_x_nm"] = placed ? Json(read.image.pitch_x_nm / scale) : Json();
  out["pitch_y_nm"] = placed ? Json(read.image.pitch_y_nm / scale) : Json();
  if (placed && read.level == 0)
    out["origin_nm"] = Json{read.image.origin_x_nm, read.image.origin_y_nm};
  out["levels"] = read.levels;
  out["level_of_values"] = read.level;
  Json channels = Json::array();
  for (const Channel& channel : read.image.channels) {
    Json one{{"name", channel.name}, {"unit", channel.unit}};
    Range range;
    for (const float value : channel.values.data()) range.add(double(value));
    range.put(one);
    one["not_finite"] = range.not_finite();
    channels.push_back(std::move(one));
  }
  out["channels"] = std::move(channels);
  put_metadata(out, read.image.metadata);
  return out;
}

Json mesh(const std::filesystem::path& path, const io::MeshUnit& unit) {
  const std::vector<io::NamedMesh> bodies = io::read_meshes(path, unit);
  const TriangleMesh all = bodies.size() == 1 ? bodies.front().mesh : io::join(bodies);
  const MeshReport report = check_mesh(all);
  Json out{{"triangles", report.triangles},
           {"vertices", report.vertices},
           {"components", report.components},
           {"closed", report.closed_and_oriented},
           {"area_nm2", report.area_nm2}};
  out["volume_nm3"] = report.closed_and_oriented ? Json(report.signed_volume_nm3) : Json();
  out["bounds_nm"] = box(report.bounds_nm);
  out["faults"] = faults(report);
  out["bodies"] = Json::array();
  for (const io::NamedMesh& body : bodies)
    out["bodies"].push_back({{"name", body.name},
                             {"material", body.material},
                             {"triangles", body.mesh.triangles.size()},
                             {"bounds_nm", box(bounds(body.mesh))}});
  const SurfaceScene scene = io::read_surfaces(path, unit);
  out["scalars"] = Json::array();
  for (const Surface& surface : scene.surfaces)
    for (const VertexScalar& scalar : surface.scalars) {
      Json one{{"name", scalar.name}, {"of", surface.name}, {"unit", scalar.unit}};
      Range range;
      for (const auto value : scalar.values) range.add(double(value));
      range.put(one);
      out["scalars"].push_back(std::move(one));
    }
  out["tracks"] = scene.tracks.size();
  put_metadata(out, scene.metadata);
  return out;
}

Json residuals(const std::vector<ModelResidual>& of) {
  Json out = Json::array();
  for (const ModelResidual& r : of)
    out.push_back({{"channel", r.channel},
                   {"rms", r.rms},
                   {"noise_rms", r.noise_rms},
                   {"mean_signal", r.mean_signal},
                   {"pixels", r.pixels}});
  return out;
}

Json model(const std::filesystem::path& path) {
  const TrainedModel trained = io::read_model(path);
  const TrainingRecord& record = trained.record;
  Json out{{"material", trained.scope.material},
           {"energy_ev", trained.scope.energy_ev},
           {"pixel_nm", trained.scope.pixel_nm},
           {"spot_nm", trained.scope.spot_nm}};
  out["surfaces"] = record.scenes.size();
  out["residuals"] = residuals(record.residuals);
  out["held_out_residuals"] = residuals(record.held_out_residuals);
  out["warnings"] = record.warnings;
  put_metadata(out, record.notes);
  return out;
}

Json scene(const std::filesystem::path& path,
           const std::vector<std::filesystem::path>& material_files) {
  const io::SceneFile read = io::read_scene(path, material_files);
  mc::validate(read.specimen);
  Json out{{"title", read.title}};
  out["bounds_nm"] = box(mc::extent(read.specimen));
  out["bodies"] = Json::array();
  const auto material = [&](int index) {
    return read.specimen.materials.at(static_cast<std::size_t>(index)).name;
  };
  for (const mc::Body& body : read.specimen.bodies)
    out["bodies"].push_back({{"name", body.name},
                             {"material", material(body.material)},
                             {"triangles", body.mesh.triangles.size()},
                             {"bounds_nm", box(bounds(body.mesh))}});
  if (const auto& s = read.specimen.substrate)
    out["substrate"] = {{"material", material(s->material)}, {"top_nm", s->top_nm}};
  const mc::Scan scan = resolve_scan(read.scan, mc::extent(read.specimen), read.beam);
  out["width"] = scan.width, out["height"] = scan.height;
  out["pitch_x_nm"] = scan.pixel_x_nm, out["pitch_y_nm"] = scan.pixel_y_nm;
  out["centre_nm"] = {scan.center_x_nm, scan.center_y_nm, scan.center_z_nm};
  out["detectors"] = Json::array();
  for (const mc::Detector& d : read.detectors) out["detectors"].push_back(mc::format_detector(d));
  out["electrons"] = mc::electrons_of(read.budget);
  out["physics"] = mc::format_physics(read.physics);
  put_metadata(out, record_of(read.beam));
  out["notes"] = read.notes;
  return out;
}

const char* name_of(FileKind kind) {
  switch (kind) {
    case FileKind::scene:
      return "scene";
    case FileKind::model:
      return "model";
    case FileKind::sem_image:
      return "SEM image";
    case FileKind::image:
      return "image";
    case FileKind::mesh:
      return "mesh";
    case FileKind::heights:
    case FileKind::unknown:
      break;
  }
  return "heights";
}

Json content(FileKind kind, const std::filesystem::path& path, const io::MeshUnit& unit,
             const std::vector<std::filesystem::path>& material_files) {
  switch (kind) {
    case FileKind::scene:
      return scene(path, material_files);
    case FileKind::model:
      return model(path);
    case FileKind::sem_image:
      return sem_image(path);
    case FileKind::image:
      return image(path);
    case FileKind::mesh:
      return mesh(path, unit);
    case FileKind::heights:
    case FileKind::unknown:
      break;
  }
  return heights(path);
}

}  // namespace

FileKind kind_of(const std::filesystem::path& path) {
  if (io::is_scene_file(path)) return FileKind::scene;
  if (io::is_model_file(path)) return FileKind::model;
  if (io::is_height_field_file(path)) return FileKind::heights;
  if (io::is_sem_image_file(path)) return FileKind::sem_image;
  if (io::is_image_file(path)) return FileKind::image;
  if (io::is_mesh_file(path) || io::has_mesh_content(path)) return FileKind::mesh;
  return FileKind::unknown;
}

std::string describe_file(const std::filesystem::path& path, const io::MeshUnit& unit,
                          const std::vector<std::filesystem::path>& material_files) {
  const FileKind kind = kind_of(path);
  Json out{{"file", path.string()}, {"kind", name_of(kind)}};
  out.update(content(kind, path, unit, material_files));
  return out.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace surf::workflow
