// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <numeric>
#include <utility>

#include "geometry/scene_impl.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/geometry/field_in_reach.h"
#include "surf/mc/geometry/shared_memory.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/open_sheet.h"

namespace surf::mc {

namespace {

// Beyond what its electrons reach inside the solid a height field is drawn out flat, this far:
// where a track through vacuum gets there it is as good as gone.
constexpr double apron_in_widths = 20;

constexpr std::size_t sky_columns = 1 << 14;

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
  if (base == 0) {   // mostly there is only one
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

// Signed volume of every component, about a point of its own: far from the origin digits would cancel.
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
                                cross(mesh.vertices_nm[t[1]] - o, mesh.vertices_nm[t[2]] - o)) / 6;
  }
  return volume;
}

void add_body(Assembly& all, const Body& body) {
  TriangleMesh mesh = merge_equal_vertices(body.mesh);
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
void add_sheet(Assembly& all, const Body& body, const Scan& scan, double reach) {
  Box needed = bounds(body.mesh);
  const double half = 0.5 * std::hypot(scan.width * scan.pixel_x_nm, scan.height * scan.pixel_y_nm);
  const Vec3 size = needed.size_nm();
  const Vec3 away = Vec3{scan.center_x_nm, scan.center_y_nm, 0} - needed.center_nm();
  const double apron = apron_in_widths * std::max(size.x, size.y) + reach + half +
                       std::hypot(away.x, away.y);
  std::string reason;
  TriangleMesh mesh = *extend_open_sheet(body.mesh, apron, reason);   // validated
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
    all.shells.push_back({static_cast<int>(all.solids.size()), c != sheet && volume[c] < 0 ? -1 : 1});
  all.solids.push_back({body.material});
}

void add_height_field(Assembly& all, const HeightFieldBody& body, const Scan& scan, double reach) {
  HeightField wide = field_in_reach(body, scan, reach);
  const double width = std::max(wide.z_nm.width() * wide.pitch_x_nm,
                                wide.z_nm.height() * wide.pitch_y_nm);
  TriangleMesh sheet = half_space_top(wide, apron_in_widths * width);
  wide = {};
  std::vector<std::uint32_t> component(sheet.triangles.size(), 0);
  append(all, std::move(sheet), std::move(component));
  all.shells.push_back({static_cast<int>(all.solids.size()), 1});
  all.solids.push_back({body.material});
}

// The part of the surface's box that electrons of the scan come near: the scanned region and the
// reach around it. Outside the box of all surfaces the distance to that box is bound enough.
Box near_scan(const Box& surface, const Scan& scan, const Beam& beam, double reach) {
  double half_x = 0.5 * scan.width * scan.pixel_x_nm, half_y = 0.5 * scan.height * scan.pixel_y_nm;
  if (beam.tilt_deg > 0) {
    // A tilted beam meets the surface beside the scan plane by up to its depth times tan(tilt).
    const double slope = std::tan(std::min(beam.tilt_deg, 85.0) * degrees_to_radians);
    half_x = half_y = std::hypot(half_x, half_y) * std::sqrt(1 + slope * slope) +
                      surface.size_nm().z * slope;
  }
  Box box = surface;
  box.lower_nm.x = std::max(box.lower_nm.x, scan.center_x_nm - half_x - reach);
  box.lower_nm.y = std::max(box.lower_nm.y, scan.center_y_nm - half_y - reach);
  box.upper_nm.x = std::min(box.upper_nm.x, scan.center_x_nm + half_x + reach);
  box.upper_nm.y = std::min(box.upper_nm.y, scan.center_y_nm + half_y + reach);
  return box;
}

// Drops the triangles that no electron comes near, and says how many.
std::size_t leave_out_unreachable(Assembly& all, std::optional<double> plane_nm, const Box& near,
                                  double reach, const Watch& watch) {
  const double lowest = near.lower_nm.z, highest = std::max(near.upper_nm.z, plane_nm.value_or(-HUGE_VAL));
  if (all.shells.size() < 2 || highest - lowest <= reach) return 0;
  const std::vector<std::uint8_t> reachable =
      reachable_triangles(all.mesh, all.shell_of, all.shells, plane_nm, near, reach, watch);
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

// An assembly, and what else the scene has to know of it.
struct Surfaces : Assembly {
  Box near;                    // the surface without aprons
  std::size_t left_out = 0;
  bool half_space = false;
  bool has_triangles = false;
};

Surfaces assemble(const Specimen& specimen, const std::vector<BodyFacts>& found, const Scan& scan,
                  double reach, double farthest_reach, const SceneOptions& options) {
  Surfaces all;
  std::optional<double> plane_nm;
  if (specimen.substrate) {
    plane_nm = specimen.substrate->top_nm;
    all.shells.push_back({0, 1});
    all.solids.push_back({specimen.substrate->material});
  }
  if (specimen.height_field) {
    add_height_field(all, *specimen.height_field, scan, reach);
    all.near.extend(bounds(all.mesh));
  }
  all.half_space = specimen.substrate || specimen.height_field;
  for (std::size_t i = 0; i < specimen.bodies.size(); ++i) {
    options.watch.check();
    const Body& body = specimen.bodies[i];
    if (found[i].is_sheet) {
      add_sheet(all, body, scan, reach);
      all.half_space = true;
    } else {
      add_body(all, body);
    }
    all.near.extend(found[i].box);
  }
  if (options.leave_out_unreachable && !all.near.empty())
    all.left_out = leave_out_unreachable(all, plane_nm, all.near, farthest_reach, options.watch);
  all.has_triangles = !all.mesh.triangles.empty();
  return all;
}

template <class T>
void put(std::string& text, const T* values, std::size_t count) {
  text.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

template <class T>
void get(const std::string& text, std::size_t& at, T* values, std::size_t count) {
  std::memcpy(values, text.data() + at, count * sizeof(T));
  at += count * sizeof(T);
}

struct Told {
  Box near;
  std::uint64_t left_out = 0, shells = 0, solids = 0;
  bool half_space = false, has_triangles = false;
};

// The first process of a machine makes it, and tells the others all but the triangles.
template <class Make>
void assemble_together(NodeMemory& node, Surfaces& all, const Make& make) {
  std::string text;
  if (node.is_first()) {
    try {
      all = make();
    } catch (const std::exception& e) {
      text = std::string("!") + e.what();
      node.tell(text);
      throw;
    }
    const Told told{all.near, all.left_out, all.shells.size(), all.solids.size(), all.half_space,
                    all.has_triangles};
    text = " ";
    put(text, &told, 1);
    put(text, all.shells.data(), all.shells.size());
    put(text, all.solids.data(), all.solids.size());
  }
  node.tell(text);
  if (node.is_first()) return;
  if (text[0] != ' ')
    throw InvalidInput("specimen", "another process of this machine says: " + text.substr(1), "See there");
  std::size_t at = 1;
  Told told;
  get(text, at, &told, 1);
  all.near = told.near;
  all.left_out = told.left_out;
  all.half_space = told.half_space;
  all.has_triangles = told.has_triangles;
  all.shells.resize(told.shells);
  all.solids.resize(told.solids);
  get(text, at, all.shells.data(), all.shells.size());
  get(text, at, all.solids.data(), all.solids.size());
}

}  // namespace

Scene::Scene(const Specimen& specimen, const Beam& beam, const Scan& scan, const Physics& physics,
             const SceneOptions& options)
    : impl_(std::make_unique<Impl>()) {
  const auto begin = std::chrono::steady_clock::now();
  validate(beam);
  validate(scan);
  validate(physics, beam.energy_ev);
  const Watch& watch = options.watch;
  if (!options.node) watch.check();   // who left now would be waited for
  const std::vector<BodyFacts>* found = options.facts;
  std::vector<BodyFacts> own;
  if (!found && (!options.node || options.node->is_first())) {
    own = validate(specimen, watch.part(0, 0.1));
    found = &own;
  }
  Impl& s = *impl_;
  s.beam = beam;
  s.scan = scan;
  s.physics = physics;
  s.materials = specimen.materials;
  double reach = 0;
  double farthest_reach = 0;   // an electron may pass through all materials on its way
  for (const Material& m : s.materials) {
    s.media.push_back(make_medium(m, physics));
    reach = std::max(reach, reach_nm(s.media.back(), beam));
    farthest_reach += s.media.back().range_nm(beam.energy_ev + s.media.back().barrier_ev());
  }
  for (const Medium& m : s.media) s.medium_pointers.push_back(&m);

  if (specimen.substrate) {
    s.plane_nm = specimen.substrate->top_nm;
    s.plane_shell = 0;
  }
  Surfaces all;
  if (!options.node) all = assemble(specimen, *found, scan, reach, farthest_reach, options);
  else assemble_together(*options.node, all,
                         [&] { return assemble(specimen, *found, scan, reach, farthest_reach, options); });
  const Box& near = all.near;
  s.summary.triangles_left_out = all.left_out;
  s.shells = std::move(all.shells);
  s.solids = std::move(all.solids);
  s.top_nm = s.plane_nm.value_or(near.empty() ? 0.0 : near.upper_nm.z);
  s.bottom_nm = near.empty() ? s.top_nm : std::min(near.lower_nm.z, s.plane_nm.value_or(HUGE_VAL));
  s.half_space = all.half_space;
  s.farthest_nm = 1e12;
  if (all.has_triangles) {
    s.top_nm = std::max(s.top_nm, near.upper_nm.z);
    SceneMesh mesh = options.node
                         ? share_scene_mesh(*options.node, std::move(all.mesh), std::move(all.shell_of))
                         : make_scene_mesh(std::move(all.mesh), std::move(all.shell_of));
    s.shell_of = mesh.shell_of;
    const Box domain = near_scan(near, scan, beam, reach);
    watch.report(0.3, 1);
    s.near = DistanceGrid(mesh.mesh, domain, options.distance_grid_bytes, 0, watch.part(0.3, 0.7));
    watch.report(0.7, 1);
    s.sky = HorizonMap(mesh.mesh, domain, sky_columns, 0, watch);
    watch.report(0.8, 1);
    s.triangles = std::make_unique<EmbreeScene>(std::move(mesh), watch.part(0.8, 1));
  }
  s.summary.triangles = s.shell_of.size();
  s.summary.shells = s.shells.size();
  s.summary.grid_cell_nm = s.near.cell_nm();
  s.summary.memory_bytes = s.near.bytes() + s.sky.bytes() + s.shell_of.size() * sizeof(std::uint32_t) +
                           (s.triangles ? s.triangles->memory_bytes() : 0);
  s.summary.build_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

const Beam& Scene::beam() const { return impl_->beam; }
const Scan& Scene::scan() const { return impl_->scan; }
const Physics& Scene::physics() const { return impl_->physics; }
const std::vector<Material>& Scene::materials() const { return impl_->materials; }
const SceneSummary& Scene::summary() const { return impl_->summary; }

bool Scene::first_surface(const Vec3& start, const Vec3& direction, Vec3& hit) const {
  SceneGeometry geometry(*impl_);
  SceneGeometry::State state = 0;
  SceneGeometry::Surface surface;
  if (geometry.crossing(start, direction, HUGE_VAL, state, surface) != Crossing::surface)
    return false;
  hit = surface.position;
  return true;
}

double Scene::distance_bound_nm(const Vec3& point) const { return impl_->clearance_nm(point); }

}  // namespace surf::mc
