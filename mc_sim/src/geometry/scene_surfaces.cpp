// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/scene_surfaces.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/reach.h"
#include "geometry/reachability.h"
#include "surf/mc/geometry/field_in_reach.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/merge_coplanar.h"
#include "surf/mesh/open_sheet.h"

namespace surf::mc {

namespace {

// Beyond what its electrons reach inside the solid a height field is drawn out flat, this far:
// where a track through vacuum gets there it is as good as gone.
constexpr double apron_in_widths = 20;

// All triangles of a scene, with the shell of each.
struct Assembly {
  TriangleMesh mesh;
  std::vector<std::uint32_t> shell_of;
  std::vector<Shell> shells;
  std::vector<Solid> solids;
};

void append(Assembly& all, TriangleMesh mesh, std::vector<std::uint32_t> component) {
  const auto base = static_cast<std::uint32_t>(all.mesh.vertices_nm.size());
  const auto first_shell = static_cast<std::uint32_t>(all.shells.size());
  if (base == 0) {  // mostly there is only one
    all.mesh = std::move(mesh);
    all.shell_of = std::move(component);
    for (std::uint32_t& shell : all.shell_of) shell += first_shell;
    return;
  }
  all.mesh.vertices_nm.insert(all.mesh.vertices_nm.end(), mesh.vertices_nm.begin(),
                              mesh.vertices_nm.end());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    all.mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    all.shell_of.push_back(first_shell + component[i]);
  }
}

// Signed volume of every component, about a point of its own: far from the origin digits would
// cancel.
std::vector<double> volumes(const TriangleMesh& mesh, const std::vector<std::uint32_t>& component) {
  constexpr std::uint32_t none = 0xffffffffu;
  const std::uint32_t count = 1 + *std::max_element(component.begin(), component.end());
  std::vector<double> volume(count, 0.0);
  std::vector<std::uint32_t> about(count, none);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    std::uint32_t& vertex = about[component[i]];
    if (vertex == none) vertex = t[0];
    const Vec3& o = mesh.vertices_nm[vertex];
    volume[component[i]] += dot(mesh.vertices_nm[t[0]] - o,
                                cross(mesh.vertices_nm[t[1]] - o, mesh.vertices_nm[t[2]] - o)) /
                            6;
  }
  return volume;
}

void add_body(Assembly& all, const Body& body, const Watch& watch) {
  TriangleMesh mesh = merge_coplanar(merge_equal_vertices(body.mesh), {.watch = watch});
  std::vector<std::uint32_t> component = triangle_components(mesh);
  std::vector<double> volume = volumes(mesh, component);
  // A mesh whose normals all point inward is turned as a whole.
  if (std::accumulate(volume.begin(), volume.end(), 0.0) < 0) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    for (double& v : volume) v = -v;
  }
  append(all, std::move(mesh), std::move(component));
  for (const double v : volume)
    all.shells.push_back({static_cast<int>(all.solids.size()), v < 0 ? -1 : 1});
  all.solids.push_back({body.material});
}

// A sheet goes on flat as far as electrons of the scan reach, and further.
void add_sheet(Assembly& all, const Body& body, const Scan& scan, double reach,
               const Watch& watch) {
  Box needed = bounds(body.mesh);
  const double half = 0.5 * std::hypot(scan.width * scan.pixel_x_nm, scan.height * scan.pixel_y_nm);
  const Vec3 size = needed.size_nm();
  const Vec3 away = Vec3{scan.center_x_nm, scan.center_y_nm, 0} - needed.center_nm();
  const double apron =
      apron_in_widths * std::max(size.x, size.y) + reach + half + std::hypot(away.x, away.y);
  std::string reason;
  const TriangleMesh merged = merge_coplanar(merge_equal_vertices(body.mesh), {.watch = watch});
  TriangleMesh mesh = *extend_open_sheet(merged, apron, reason);  // validated
  std::vector<std::uint32_t> component = triangle_components(mesh);
  const std::vector<double> volume = volumes(mesh, component);
  // The apron's vertices come last: what holds the last one is the sheet.
  const auto last = static_cast<std::uint32_t>(mesh.vertices_nm.size() - 1);
  std::uint32_t sheet = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i])
      if (v == last) sheet = component[i];
  append(all, std::move(mesh), std::move(component));
  for (std::uint32_t c = 0; c < volume.size(); ++c)
    all.shells.push_back(
        {static_cast<int>(all.solids.size()), c != sheet && volume[c] < 0 ? -1 : 1});
  all.solids.push_back({body.material});
}

void add_height_field(Assembly& all, const HeightFieldBody& body, const Scan& scan, double reach,
                      const Watch& watch) {
  HeightField wide = field_in_reach(body, scan, reach);
  const double width =
      std::max(wide.z_nm.width() * wide.pitch_x_nm, wide.z_nm.height() * wide.pitch_y_nm);
  TriangleMesh sheet = half_space_top(wide, apron_in_widths * width);
  wide = {};
  sheet = merge_coplanar(std::move(sheet), {.watch = watch});
  std::vector<std::uint32_t> component(sheet.triangles.size(), 0);
  append(all, std::move(sheet), std::move(component));
  all.shells.push_back({static_cast<int>(all.solids.size()), 1});
  all.solids.push_back({body.material});
}

// Drops the triangles that no electron comes near, and says how many.
std::size_t leave_out_unreachable(Assembly& all, std::optional<double> plane_nm, const Box& box,
                                  double reach, const Watch& watch) {
  const double lowest = box.lower_nm.z,
               highest = std::max(box.upper_nm.z, plane_nm.value_or(-HUGE_VAL));
  if (all.shells.size() < 2 || highest - lowest <= reach) return 0;
  const std::vector<std::uint8_t> reachable =
      reachable_triangles(all.mesh, all.shell_of, all.shells, plane_nm, box, reach, watch);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < reachable.size(); ++i) {
    if (!reachable[i]) continue;
    all.mesh.triangles[kept] = all.mesh.triangles[i];
    all.shell_of[kept++] = all.shell_of[i];
  }
  all.mesh.triangles.resize(kept);
  all.shell_of.resize(kept);
  return reachable.size() - kept;
}

}  // namespace

SceneSurfaces make_surfaces(const Specimen& specimen, const std::vector<BodyFacts>& facts,
                            const Beam& beam, const Scan& scan, const Physics& physics,
                            const SurfaceOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  validate(beam);
  validate(scan);
  validate(physics, beam.energy_ev);
  const Reach reach = reach_of(make_media(specimen.materials, physics), beam);
  const Watch watch{{}, options.watch.cancel};
  SceneSurfaces out;
  Assembly all;
  if (specimen.substrate) {
    out.plane_nm = specimen.substrate->top_nm;
    all.shells.push_back({0, 1});
    all.solids.push_back({specimen.substrate->material});
  }
  if (specimen.height_field) {
    add_height_field(all, *specimen.height_field, scan, reach.of_any_nm, watch);
    out.box.extend(bounds(all.mesh));
  }
  out.half_space = specimen.substrate || specimen.height_field;
  for (std::size_t i = 0; i < specimen.bodies.size(); ++i) {
    watch.check();
    const Body& body = specimen.bodies[i];
    if (facts[i].is_sheet) {
      add_sheet(all, body, scan, reach.of_any_nm, watch);
      out.half_space = true;
    } else {
      add_body(all, body, watch);
    }
    out.box.extend(facts[i].box);
  }
  if (options.leave_out_unreachable && !out.box.empty())
    out.triangles_left_out =
        leave_out_unreachable(all, out.plane_nm, out.box, reach.through_all_nm, watch);
  out.shells = std::move(all.shells);
  out.solids = std::move(all.solids);
  if (!all.mesh.triangles.empty())
    out.mesh = make_scene_mesh(std::move(all.mesh), std::move(all.shell_of));
  out.build_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace surf::mc
