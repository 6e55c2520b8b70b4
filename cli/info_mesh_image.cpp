// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "info.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sem_file.h"
#include "surf/io/surface_file.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/open_sheet.h"
#include "terminal.h"

namespace surf::cli {
namespace {

// An area or volume in the unit that its edge would have: nm^2, um^2, mm^3 ...
std::string format_power(double value, int power) {
  const double edge_nm = std::pow(std::abs(value), 1.0 / power);
  const auto [unit, nm] = edge_nm < 1e3   ? std::pair{"nm", 1.0}
                          : edge_nm < 1e6 ? std::pair{"um", 1e3}
                          : edge_nm < 1e9 ? std::pair{"mm", 1e6}
                                          : std::pair{"m", 1e9};
  return fmt::format("{:.4g} {}^{}", value / std::pow(nm, power), unit, power);
}

// Narrower or wider than any specimen of a microscope: the unit is likely not what was meant.
constexpr double narrowest_nm = 1, widest_nm = 1e7;

std::string size_warning(double wide_nm, double unit_nm) {
  constexpr double typical_nm = 3e3;
  const auto off = [&](double nm) { return std::abs(std::log10(nm / typical_nm)); };
  std::pair<const char*, double> best{"nm", 1};
  for (const auto& [unit, nm] :
       {std::pair{"pm", 1e-3}, {"nm", 1.0}, {"um", 1e3}, {"mm", 1e6}, {"m", 1e9}}) {
    if (off(wide_nm / unit_nm * nm) < off(wide_nm / unit_nm * best.second)) best = {unit, nm};
  }
  const double then_nm = wide_nm / unit_nm * best.second;
  if (then_nm < narrowest_nm || then_nm > widest_nm)
    return fmt::format("{} wide; is --unit right?", format_length(wide_nm));
  return fmt::format("{} wide; is --unit right? With --unit {} it would be {}",
                     format_length(wide_nm), best.first, format_length(then_nm));
}

void print_mesh_warnings(const MeshReport& r, const TriangleMesh& mesh,
                         const std::filesystem::path& path, double unit_nm) {
  const auto warn = [](const std::string& text) { print_item("warning", text); };
  for (const std::string& fault : faults(r)) warn(fault);
  std::string why_no_sheet;
  const bool sheet = r.boundary_edges > 0 && extend_open_sheet(mesh, 1, why_no_sheet).has_value();
  if (sheet) print_item("sheet", "simulate takes it as the top of a half-space");
  else if (!r.closed_and_oriented)
    warn("not closed or not oriented: it cannot be simulated as it is");
  const bool inward = r.closed_and_oriented && r.signed_volume_nm3 < 0;
  if (inward) warn("normals point inward; simulate takes them as pointing outward");
  if ((!r.closed_and_oriented && !sheet) || inward ||
      r.degenerate_triangles + r.duplicate_triangles > 0)
    print_item("try", fmt::format("semsurf mesh {} --repair -o {}", path.string(),
                                  path.stem().string() + "_repaired.ply"));
  const Vec3 size = r.bounds_nm.size_nm();
  const double widest = std::max({size.x, size.y, size.z});
  if (widest > 0 && (widest > widest_nm || widest < narrowest_nm))
    warn(size_warning(widest, unit_nm));
}

void print_body(const io::NamedMesh& body) {
  print_item("body", fmt::format("{}{}, {} triangles, {}", body.name,
                                 body.material.empty() ? "" : ", material " + body.material,
                                 body.mesh.triangles.size(), format_extent(bounds(body.mesh))));
}

void print_channel(const Channel& channel, std::size_t label_width) {
  double sum = 0, lowest = HUGE_VAL, highest = -HUGE_VAL;
  std::size_t finite = 0;
  for (const float value : channel.values.data()) {
    if (!std::isfinite(value)) continue;
    lowest = std::min(lowest, double(value));
    highest = std::max(highest, double(value));
    sum += value;
    ++finite;
  }
  const std::string unit = channel.unit.empty() || channel.unit == "1" ? "" : " " + channel.unit;
  std::string text = finite == 0 ? "no finite value"
                                 : fmt::format("{:.6g} to {:.6g}, mean {:.6g}{}", lowest, highest,
                                               sum / double(finite), unit);
  if (finite > 0 && finite < channel.values.size())
    text += fmt::format(", {} not finite", channel.values.size() - finite);
  print_item(fmt::format("{:<{}}", channel.name, label_width), text);
}

void print_how_made(const std::map<std::string, std::string>& metadata) {
  if (metadata.empty()) return;
  print("  how it was made\n");
  std::size_t longest = 0;
  for (const auto& item : metadata) longest = std::max(longest, item.first.size());
  for (const auto& [key, value] : metadata) print("    {:<{}}  {}\n", key, longest, value);
}

struct DescribedPixel {
  double x_nm, y_nm;
  std::string from;
};

/// What ImageJ or OME-TIFF wrote of a picture's pixels.
std::optional<DescribedPixel> described_pixel(const std::filesystem::path& path) {
  try {
    const io::SemFile file = io::read_sem_image(path);
    return DescribedPixel{file.image.pitch_x_nm, file.image.pitch_y_nm, file.pixel_from};
  } catch (const Error&) {
    return std::nullopt;  // there is nothing, or the picture is in colour
  }
}

/// What a mesh file says besides its triangles.
void print_attributes(const SurfaceScene& scene) {
  for (const Surface& surface : scene.surfaces) {
    const std::string of = scene.surfaces.size() > 1 ? " of " + surface.name : "";
    for (const VertexScalar& scalar : surface.scalars) {
      const auto [low, high] = std::ranges::minmax(scalar.values);
      print_item("scalar",
                 fmt::format("{}{}, {:.6g} to {:.6g}{}", scalar.name, of, low, high,
                             scalar.unit.empty() || scalar.unit == "1" ? "" : " " + scalar.unit));
    }
    if (surface.drape)
      print_item("picture", fmt::format("{}{}, {} x {} pixels of {} x {}", surface.drape->name, of,
                                        surface.drape->grey.width(), surface.drape->grey.height(),
                                        format_length(surface.drape->pitch_x_nm),
                                        format_length(surface.drape->pitch_y_nm)));
  }
  if (!scene.tracks.empty()) print_item("tracks", std::to_string(scene.tracks.size()));
  print_how_made(scene.metadata);
}

}  // namespace

void print_mesh(const std::filesystem::path& path, const io::MeshUnit& unit) {
  const std::vector<io::NamedMesh> bodies = io::read_meshes(path, unit);
  const TriangleMesh mesh = bodies.size() == 1 ? bodies.front().mesh : io::join(bodies);
  const MeshReport report = check_mesh(mesh);
  print("{}: mesh{}\n", path.string(),
        bodies.size() == 1 ? "" : fmt::format(" of {} bodies", bodies.size()));
  for (const io::NamedMesh& body : bodies)
    if (bodies.size() > 1 || !body.material.empty()) print_body(body);
  print_item("shape", summary(report));
  print_item("size", format_extent(report.bounds_nm));
  print_item("bounds", format_bounds(report.bounds_nm));
  print_item("area", format_power(report.area_nm2, 2));
  if (report.closed_and_oriented)
    print_item("volume", format_power(std::abs(report.signed_volume_nm3), 3));
  const std::string extension = path.extension().string();
  const double file_unit_nm = extension == ".glb" || extension == ".gltf" ? 1e9 : 1;
  print_mesh_warnings(report, mesh, path, unit.nm.value_or(file_unit_nm));
  print_attributes(io::read_surfaces(path, unit));
}

void print_image(const std::filesystem::path& path) {
  constexpr std::int64_t most_pixels = std::int64_t{1}
                                       << 25;  // larger ones are looked at in a smaller size
  const io::ImageLevel read = io::read_image_within(path, most_pixels);
  const Image& image = read.image;
  const double scale = std::ldexp(1.0, read.level);
  double pitch_x_nm = image.pitch_x_nm / scale, pitch_y_nm = image.pitch_y_nm / scale;
  const bool placed = io::states_pixel_size(image);
  const std::optional<DescribedPixel> described = placed ? std::nullopt : described_pixel(path);
  if (described) std::tie(pitch_x_nm, pitch_y_nm) = std::pair(described->x_nm, described->y_nm);
  print("{}: image\n", path.string());
  const std::string pixels = fmt::format("{} x {} pixels", read.whole.width, read.whole.height);
  print_item("size", !placed && !described
                         ? pixels + "; the file does not say how large they are"
                         : fmt::format("{} of {} x {}, {} x {}", pixels, format_length(pitch_x_nm),
                                       format_length(pitch_y_nm),
                                       format_length(read.whole.width * pitch_x_nm),
                                       format_length(read.whole.height * pitch_y_nm)));
  if (described) print_item("from", described->from);
  if (read.levels > 1)
    print_item("pyramid",
               fmt::format("{} sizes{}", read.levels,
                           read.level == 0 ? ""
                                           : fmt::format("; values below are of {} x {} means",
                                                         image.width(), image.height())));
  if (read.level == 0 && placed)
    print_item("origin",
               fmt::format("lower-left pixel's centre at {}, {} nm",
                           format_exact(image.origin_x_nm), format_exact(image.origin_y_nm)));
  std::size_t label_width = 0;
  for (const Channel& channel : image.channels)
    label_width = std::max(label_width, channel.name.size());
  for (const Channel& channel : image.channels) print_channel(channel, label_width);
  print_how_made(image.metadata);
}

}  // namespace surf::cli
