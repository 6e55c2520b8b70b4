// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/simplify_specimen.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/geometry/field_in_reach.h"
#include "surf/mc/physics/medium.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/open_sheet.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/thin_height_field.h"
#include "surf/mesh/touching_vertices.h"

namespace surf::workflow {
namespace {

constexpr double one_interface_nm = 1e-3;  // nearer faces are one interface (see mc::Specimen)
// Keeping a larger share of the triangles is not worth a change.
constexpr double least_gain = 0.95;
constexpr int attempts = 3;  // each with half the tolerance of the previous one

constexpr const char* tolerance = "`simulation.mesh_tolerance`";

std::string name_of(const mc::Body& body) { return body.name.empty() ? "body" : body.name; }

std::string name_of(const mc::HeightFieldBody& body) {
  return body.name.empty() ? "height field" : body.name;
}

double relief_nm(const HeightField& field) {
  const auto [low, high] = std::ranges::minmax_element(field.z_nm.data());
  return *high - *low;
}

void require_smaller(double tolerance_nm, double size_nm, const std::string& name) {
  if (tolerance_nm < size_nm) return;
  throw UsageError(tolerance,
                   fmt::format("{} leaves nothing of {}, which is {} across where it is thinnest",
                               format_length(tolerance_nm), name, format_length(size_nm)),
                   "Give a length well below the smallest detail that matters");
}

void check_tolerance(const mc::Specimen& specimen, double tolerance_nm) {
  if (!(std::isfinite(tolerance_nm) && tolerance_nm > 0))
    throw UsageError(tolerance, "it is " + format_exact(tolerance_nm) + " nm",
                     "Give a length above 0, as 0.5nm");
  if (const auto& h = specimen.height_field) {
    const HeightField& f = h->field;
    require_smaller(
        tolerance_nm,
        std::min((f.z_nm.width() - 1) * f.pitch_x_nm, (f.z_nm.height() - 1) * f.pitch_y_nm),
        name_of(*h));
  }
  for (const mc::Body& body : specimen.bodies) {
    const Vec3 size = bounds(body.mesh).size_nm();
    const double flat = std::min(size.x, size.y);
    require_smaller(tolerance_nm, mc::is_sheet(body) ? flat : std::min(flat, size.z),
                    name_of(body));
  }
}

// The vertices that stay in place, so that bodies keep touching.
std::vector<Vec3> contacts(const mc::Specimen& specimen, std::size_t of) {
  const TriangleMesh& mesh = specimen.bodies[of].mesh;
  std::vector<std::uint8_t> touching(mesh.vertices_nm.size(), 0);
  const auto add = [&](const TriangleMesh& other) {
    const auto more = touching_vertices(mesh, other, one_interface_nm);
    for (std::size_t i = 0; i < more.size(); ++i) touching[i] |= more[i];
  };
  for (std::size_t i = 0; i < specimen.bodies.size(); ++i)
    if (i != of) add(specimen.bodies[i].mesh);
  if (specimen.height_field) add(height_field_sheet(specimen.height_field->field));
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < touching.size(); ++i) {
    const Vec3& p = mesh.vertices_nm[i];
    if (touching[i] ||
        (specimen.substrate && std::abs(p.z - specimen.substrate->top_nm) <= one_interface_nm))
      places.push_back(p);
  }
  return places;
}

bool something_stands_on(const HeightField& field, const std::vector<mc::Body>& bodies) {
  if (bodies.empty()) return false;
  const TriangleMesh sheet = height_field_sheet(field);
  return std::ranges::any_of(bodies, [&](const mc::Body& body) {
    const auto touching = touching_vertices(body.mesh, sheet, one_interface_nm);
    return std::ranges::find(touching, 1) != touching.end();
  });
}

// Says why a simplified mesh cannot replace the original; empty if it can.
std::string fault(const TriangleMesh& simple, const TriangleMesh& original, int threads,
                  const Watch& watch) {
  const MeshReport now = check_mesh(simple, watch), before = check_mesh(original, watch);
  if (now.boundary_edges > 0) {
    std::string reason;
    if (before.boundary_edges == 0 || !extend_open_sheet(simple, 1, reason))
      return "it would be open";
  } else if (!now.closed_and_oriented || !(now.signed_volume_nm3 * before.signed_volume_nm3 > 0)) {
    return "it would have no inside";
  }
  const SelfIntersections crossings =
      find_self_intersections(simple, {.threads = threads, .watch = watch});
  if (crossings.pairs.empty() ||
      crossings.pairs.size() <=
          find_self_intersections(original, {.threads = threads, .watch = watch}).pairs.size())
    return "";
  return fmt::format("it would pass through itself near ({:g}, {:g}, {:g}) nm",
                     crossings.first_nm.x, crossings.first_nm.y, crossings.first_nm.z);
}

bool gains(std::size_t after, std::size_t before) {
  return static_cast<double>(after) <= least_gain * static_cast<double>(before);
}

SimplifiedBody simplify_body(const mc::Specimen& specimen, std::size_t number, double tolerance_nm,
                             int threads, const Watch& watch, mc::Body& body) {
  SimplifiedBody done;
  done.name = name_of(body);
  done.triangles_before = done.triangles_after = body.mesh.triangles.size();
  SimplifyOptions options{.tolerance_nm = tolerance_nm,
                          .fixed_nm = contacts(specimen, number),
                          .threads = threads,
                          .watch = watch};
  for (int i = 0; i < attempts; ++i, options.tolerance_nm /= 2) {
    auto [simple, summary] = simplify_mesh(body.mesh, options);
    if (!gains(summary.triangles_after, summary.triangles_before)) {
      if (done.kept.empty()) done.kept = "nothing would be gained";
      return done;
    }
    done.kept = fault(simple, body.mesh, threads, {{}, watch.cancel});
    if (!done.kept.empty()) continue;
    done.triangles_after = summary.triangles_after;
    done.deviation_nm = summary.deviation.largest_nm();
    body.mesh = std::move(simple);
    return done;
  }
  return done;
}

SimplifiedBody simplify_field(double tolerance_nm, const mc::Beam& beam, const mc::Scan& scan,
                              const mc::Physics& physics, const Watch& watch,
                              mc::Specimen& specimen) {
  const mc::HeightFieldBody& body = *specimen.height_field;
  double reach = 0;
  for (const mc::Material& m : specimen.materials)
    reach = std::max(reach, mc::reach_nm(mc::make_medium(m, physics), beam));
  const HeightField wide = mc::field_in_reach(body, scan, reach);
  SimplifiedBody done;
  done.name = name_of(body);
  done.triangles_before = done.triangles_after = std::size_t{2} *
                                                 static_cast<std::size_t>(wide.z_nm.width() - 1) *
                                                 static_cast<std::size_t>(wide.z_nm.height() - 1);
  if (something_stands_on(body.field, specimen.bodies)) {
    done.kept = "bodies stand on it";
    return done;
  }
  auto [sheet, summary] = thin_height_field(wide, {.tolerance_nm = tolerance_nm, .watch = watch});
  if (!gains(summary.triangles_after, summary.triangles_before)) {
    done.kept = "nothing would be gained";
  } else {
    done.triangles_after = summary.triangles_after;
    done.deviation_nm = summary.deviation_nm;
    specimen.bodies.insert(specimen.bodies.begin(), {body.name, std::move(sheet), body.material});
    specimen.height_field.reset();
  }
  return done;
}

}  // namespace

mc::Specimen simplify_specimen(const mc::Specimen& specimen, double tolerance_nm,
                               const mc::Beam& beam, const mc::Scan& scan,
                               const mc::Physics& physics, int threads, Simplification& out,
                               const Watch& watch) {
  const auto begin = std::chrono::steady_clock::now();
  mc::validate(specimen);
  check_tolerance(specimen, tolerance_nm);
  out = {};
  out.tolerance_nm = tolerance_nm;
  mc::Specimen simple = specimen;
  for (std::size_t i = 0; i < specimen.bodies.size(); ++i)
    out.bodies.push_back(
        simplify_body(specimen, i, tolerance_nm, threads, {{}, watch.cancel}, simple.bodies[i]));
  if (specimen.height_field)
    out.bodies.insert(out.bodies.begin(),
                      simplify_field(tolerance_nm, beam, scan, physics, watch, simple));
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return simple;
}

std::vector<std::string> warnings_of(const mc::Specimen& specimen, const Simplification& done) {
  std::vector<std::string> out;
  if (done.tolerance_nm > 0 && done.bodies.empty())
    out.push_back(fmt::format("{}: a bare substrate has no triangles to leave out", tolerance));
  for (const SimplifiedBody& body : done.bodies)
    if (!body.kept.empty())
      out.push_back(fmt::format("{}: with `simulation.mesh_tolerance={}` {}; it stays as it is",
                                body.name, format_length(done.tolerance_nm), body.kept));
  if (!specimen.height_field) return out;
  const double relief = relief_nm(specimen.height_field->field);
  // A plane through its middle would satisfy the tolerance.
  if (relief > 0 && relief <= 2 * done.tolerance_nm)
    out.push_back(fmt::format("{}: its whole relief, {}, is within twice {} and may vanish",
                              name_of(*specimen.height_field), format_length(relief),
                              format_length(done.tolerance_nm)));
  return out;
}

std::string describe(const SimplifiedBody& body) {
  if (!body.kept.empty()) return fmt::format("{}: as it is, {}", body.name, body.kept);
  return fmt::format("{}: {} triangles to {}, at most {} off", body.name, body.triangles_before,
                     body.triangles_after, format_length(body.deviation_nm));
}

}  // namespace surf::workflow
