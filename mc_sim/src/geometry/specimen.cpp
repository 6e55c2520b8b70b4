// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/specimen.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/geometry/largest_length.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/open_sheet.h"

namespace surf::mc {

namespace {

constexpr double thinnest_nm = 0.01;  // ten times the distance at which faces are one interface

std::string place(const Vec3& p) { return fmt::format("({:g}, {:g}, {:g}) nm", p.x, p.y, p.z); }

Box field_box(const HeightField& f) {
  Box box;
  const auto [low, high] = std::minmax_element(f.z_nm.data().begin(), f.z_nm.data().end());
  box.extend(Vec3{f.x_nm(0), f.y_nm(0), *low});
  box.extend(Vec3{f.x_nm(f.z_nm.width() - 1), f.y_nm(f.z_nm.height() - 1), *high});
  return box;
}

void check_material(const Specimen& specimen, int material, const std::string& owner) {
  if (material < 0 || material >= static_cast<int>(specimen.materials.size()))
    throw InvalidInput(owner, fmt::format("its material number {} does not exist", material),
                       "Choose one of the specimen's materials");
}

std::string repaired(const std::string& name) {
  return std::filesystem::path(name).stem().string() + "_repaired.ply";
}

std::string repair_command(const std::string& name) {
  return fmt::format("Try: semsurf mesh {} --repair -o {}", name, repaired(name));
}

[[noreturn]] void refuse_open(const std::string& subject, const MeshReport& report,
                              const std::string& why_no_sheet) {
  throw InvalidInput(
      subject,
      fmt::format("the mesh is open: {} of its edges have a triangle on one side only, the first "
                  "near {}; and it cannot stand for the top of a half-space: {}",
                  report.boundary_edges, place(report.first_boundary_nm), why_no_sheet),
      fmt::format("Try: semsurf mesh {} --repair -o {} (--max-hole LENGTH fills larger holes)",
                  subject, repaired(subject)));
}

[[noreturn]] void refuse_unoriented(const std::string& subject, const MeshReport& report) {
  throw InvalidInput(
      subject,
      report.nonmanifold_edges > 0
          ? fmt::format("at {} edges several triangles meet without an inside, the first near {}",
                        report.nonmanifold_edges, place(report.first_nonmanifold_nm))
          : fmt::format("triangles next to each other face opposite ways at {} edges, the first "
                        "near {}",
                        report.inconsistent_edges, place(report.first_inconsistent_nm)),
      repair_command(subject));
}

void check_reach(const Box& box, const std::string& subject, const char* remedy) {
  for (const Vec3& p : {box.lower_nm, box.upper_nm})
    for (const double at_nm : {p.x, p.y, p.z})
      if (!(std::abs(at_nm) <= largest_length_nm))
        throw InvalidInput(
            subject,
            fmt::format("it reaches {:.6g} nm from the origin, and {:g} nm (10 km) is the most",
                        std::abs(at_nm), largest_length_nm),
            remedy);
}

BodyFacts check_body(const Body& body, const Watch& watch) {
  const std::string subject = body.name.empty() ? "body" : body.name;
  validate(body.mesh, subject.c_str());
  check_reach(bounds(body.mesh), subject, "Check its unit (`specimen.unit`), or move it closer");
  const MeshReport report = check_mesh(body.mesh, watch);
  if (report.boundary_edges > 0) {
    std::string reason;
    if (!extend_open_sheet(body.mesh, 1, reason)) refuse_open(subject, report, reason);
    return {report.triangles, report.bounds_nm, true, false};
  }
  if (!report.closed_and_oriented) refuse_unoriented(subject, report);
  const Vec3 size = report.bounds_nm.size_nm();
  if (std::min({size.x, size.y, size.z}) < thinnest_nm)
    throw InvalidInput(subject,
                       fmt::format("the body is only {:g} nm thick: faces within 1e-3 nm count as "
                                   "one",
                                   std::min({size.x, size.y, size.z})),
                       "Check its unit (`specimen.unit`)");
  if (report.signed_volume_nm3 == 0)
    throw InvalidInput(subject, "the mesh encloses no volume", "Give it thickness");
  return {report.triangles, report.bounds_nm, false, report.signed_volume_nm3 < 0};
}

}  // namespace

bool is_sheet(const Body& body, const Watch& watch) {
  return check_mesh(body.mesh, watch).boundary_edges > 0;
}

std::vector<BodyFacts> validate(const Specimen& specimen, const Watch& watch) {
  const Watch silent{{}, watch.cancel};
  for (const Material& m : specimen.materials) validate(m);
  if (!specimen.substrate && !specimen.height_field && specimen.bodies.empty())
    throw InvalidInput("specimen", "there is nothing in it", "Add a mesh, a field or a substrate");
  if (specimen.substrate) {
    check_material(specimen, specimen.substrate->material, "substrate");
    const double top_nm = specimen.substrate->top_nm;
    if (!(std::abs(top_nm) <= largest_length_nm))
      throw InvalidInput("substrate",
                         fmt::format("its top at {:.6g} nm is not in -{:g} to {:g} nm", top_nm,
                                     largest_length_nm, largest_length_nm),
                         "Give a height such as 0nm (`specimen.substrate_z`)");
  }
  if (specimen.height_field) {
    const std::string& name = specimen.height_field->name;
    check_material(specimen, specimen.height_field->material, "height field");
    const std::string subject = name.empty() ? "height field" : name;
    surf::validate(specimen.height_field->field, subject.c_str());
    check_reach(field_box(specimen.height_field->field), subject,
                "Check its units (`scan.height_pitch`, `scan.height_unit`)");
  }
  std::vector<BodyFacts> facts;
  for (const Body& body : specimen.bodies) {
    check_material(specimen, body.material, body.name.empty() ? "body" : body.name);
    facts.push_back(check_body(body, silent));
  }
  return facts;
}

Box extent(const Specimen& specimen) {
  Box box;
  if (specimen.height_field) box.extend(field_box(specimen.height_field->field));
  for (const Body& body : specimen.bodies) box.extend(bounds(body.mesh));
  if (box.empty() && specimen.substrate) {
    const double z = specimen.substrate->top_nm;
    box.extend(Vec3{-500, -500, z});
    box.extend(Vec3{500, 500, z});
  }
  return box;
}

}  // namespace surf::mc
