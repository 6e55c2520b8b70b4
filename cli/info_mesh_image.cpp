// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "info.h"
#include "surf/core/units.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/mesh/check_mesh.h"

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

void print_mesh_warnings(const MeshReport& r) {
  const auto warn = [](const std::string& text) { print_item("warning", text); };
  if (!r.closed_and_oriented) warn("not closed or not oriented: it cannot be simulated as it is");
  if (r.closed_and_oriented && r.signed_volume_nm3 < 0)
    warn("normals point inward; simulate takes them as pointing outward");
  if (r.degenerate_triangles)
    warn(fmt::format("{} triangles without area", r.degenerate_triangles));
  if (r.duplicate_triangles) warn(fmt::format("{} triangles given twice", r.duplicate_triangles));
  const Vec3 size = r.bounds_nm.size_nm();
  const double widest = std::max({size.x, size.y, size.z});
  if (widest > 1e9 || widest < 0.1)
    warn(fmt::format("{} wide; is --unit right?", format_length(widest)));
}

void print_body(const io::NamedMesh& body) {
  print_item("body", fmt::format("{}{}, {} triangles, {}", body.name,
                                 body.material.empty() ? "" : ", material " + body.material,
                                 body.mesh.triangles.size(), format_extent(bounds(body.mesh))));
}

void print_channel(const Channel& channel) {
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
  std::string text =
      finite == 0 ? "no finite value"
                  : fmt::format("{:.6g} to {:.6g}, mean {:.6g}{}", lowest, highest,
                                sum / double(finite), unit);
  if (finite > 0 && finite < channel.values.size())
    text += fmt::format(", {} not finite", channel.values.size() - finite);
  print_item(fmt::format("{:<{}}", channel.name, label_width), text);
}

}  // namespace

void print_mesh(const std::filesystem::path& path, std::optional<double> unit_nm) {
  const std::vector<io::NamedMesh> bodies = io::read_meshes(path, unit_nm);
  const MeshReport report = check_mesh(bodies.size() == 1 ? bodies.front().mesh : io::join(bodies));
  fmt::print("{}: mesh{}\n", path.string(),
             bodies.size() == 1 ? "" : fmt::format(" of {} bodies", bodies.size()));
  for (const io::NamedMesh& body : bodies)
    if (bodies.size() > 1 || !body.material.empty()) print_body(body);
  print_item("shape", summary(report));
  print_item("size", format_extent(report.bounds_nm));
  print_item("bounds", format_bounds(report.bounds_nm));
  print_item("area", format_power(report.area_nm2, 2));
  if (report.closed_and_oriented)
    print_item("volume", format_power(std::abs(report.signed_volume_nm3), 3));
  print_mesh_warnings(report);
}

void print_image(const std::filesystem::path& path) {
  const Image image = io::read_image(path);
  fmt::print("{}: image\n", path.string());
  print_item("size", fmt::format("{} x {} pixels of {} x {}, {} x {}", image.width(),
                                 image.height(), format_length(image.pitch_x_nm),
                                 format_length(image.pitch_y_nm),
                                 format_length(image.width() * image.pitch_x_nm),
                                 format_length(image.height() * image.pitch_y_nm)));
  print_item("origin", fmt::format("lower-left pixel's centre at {}, {} nm",
                                   format_exact(image.origin_x_nm),
                                   format_exact(image.origin_y_nm)));
  std::size_t label_width = 0;
  for (const Channel& channel : image.channels)
    label_width = std::max(label_width, channel.name.size());
  for (const Channel& channel : image.channels) print_channel(channel, label_width);
  if (image.metadata.empty()) return;
  fmt::print("  how it was made\n");
  std::size_t longest = 0;
  for (const auto& item : image.metadata) longest = std::max(longest, item.first.size());
  for (const auto& [key, value] : image.metadata)
    fmt::print("    {:<{}}  {}\n", key, longest, value);
}

}  // namespace surf::cli
