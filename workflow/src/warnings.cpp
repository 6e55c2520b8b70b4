// SPDX-License-Identifier: GPL-3.0-or-later
#include "warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "surf/core/units.h"
#include "surf/mc/physics/electron_range.h"
#include "surf/mc/physics/material_doubts.h"

namespace surf::workflow {
namespace {

constexpr double widest_nm = 1e9;         // a metre: no specimen chamber is wider
constexpr double narrowest_nm = 0.1;      // an atom
constexpr double finest_pixel_nm = 1e-3;  // surfaces are not more accurate than this
// Of coordinates: a tenth of the distance at which faces coincide.
constexpr double coarsest_nm = 1e-4;
constexpr double transparent_share = 0.1;  // of the electrons' range
constexpr double lost_fraction = 1e-6;

void warn_about_bodies(const mc::Specimen& specimen, const SpecimenFacts& facts,
                       std::vector<std::string>& out) {
  for (std::size_t i = 0; i < specimen.bodies.size(); ++i) {
    const mc::Body& body = specimen.bodies[i];
    if (facts.bodies[i].is_sheet)
      out.push_back(body.name +
                    ": the mesh is open; it is taken as the top of a half-space that goes "
                    "on flat beyond its rim");
    else if (facts.bodies[i].inward)
      out.push_back(body.name + ": its normals point inward; they are taken as pointing outward");
  }
  if (!specimen.substrate) return;
  const double top_nm = specimen.substrate->top_nm;
  for (std::size_t i = 0; i < specimen.bodies.size(); ++i)
    if (facts.bodies[i].box.upper_nm.z <= top_nm)
      out.push_back(fmt::format("{}: all of it lies below the substrate's top at {}",
                                specimen.bodies[i].name, format_length(top_nm)));
}

void warn_about_size(const Box& extent, std::vector<std::string>& out) {
  const Vec3 size = extent.size_nm();
  const double widest = std::max({size.x, size.y, size.z});
  if (widest > widest_nm || widest < narrowest_nm)
    out.push_back(
        fmt::format("the specimen is {} wide; is `specimen.unit` right?", format_length(widest)));
  double farthest = 0;
  for (const Vec3& p : {extent.lower_nm, extent.upper_nm})
    farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const double step = farthest * std::numeric_limits<double>::epsilon();
  if (step > coarsest_nm)
    out.push_back(
        fmt::format("the specimen lies {} from the origin, where coordinates are {:.1g} nm apart; "
                    "move it closer",
                    format_length(farthest), step));
}

/// Warns about bodies that electrons pass through: a mesh in um that was read as nm is a speck.
/// Films and particles on a substrate are not meant, and neither are meshes with a stated unit.
void warn_about_transparency(const io::SceneFile& scene, const SpecimenFacts& facts,
                             std::vector<std::string>& out) {
  const mc::Specimen& specimen = scene.specimen;
  const bool on_matter = specimen.substrate || specimen.height_field ||
                         std::ranges::any_of(facts.bodies, &mc::BodyFacts::is_sheet);
  if (!scene.unit_assumed || on_matter) return;
  const Vec3 size = facts.extent.size_nm();
  const double widest = std::max({size.x, size.y, size.z});
  const mc::Material* densest = nullptr;
  double range = HUGE_VAL;
  for (const mc::Body& body : specimen.bodies) {
    const mc::Material& material = specimen.materials[static_cast<std::size_t>(body.material)];
    const double here = mc::kanaya_okayama_range_nm(material, scene.beam.energy_ev);
    if (here < range) densest = &material, range = here;
  }
  if (!densest || !(widest < transparent_share * range)) return;
  std::string other;
  for (const auto& [unit, factor] : {std::pair{"um", 1e3}, {"mm", 1e6}, {"m", 1e9}})
    if (other.empty() && factor * widest >= range)
      other = fmt::format("With `specimen.unit={}` it would be {}. ", unit,
                          format_length(factor * widest));
  out.push_back(fmt::format(
      "the specimen is {} wide, but electrons of {:g} eV reach about {} in {}: nearly all pass "
      "through it. {}Name the mesh file's unit, `specimen.unit` or 'unit' in a scene file; nm if "
      "it is right",
      format_length(widest), scene.beam.energy_ev, format_length(range), densest->name, other));
}

void warn_about_scan(const mc::Specimen& specimen, const Box& extent, const mc::Beam& beam,
                     const mc::Scan& scan, std::vector<std::string>& out) {
  const double half_x = 0.5 * scan.width * scan.pixel_x_nm;
  const double half_y = 0.5 * scan.height * scan.pixel_y_nm;
  const double x0 = scan.center_x_nm - half_x, x1 = scan.center_x_nm + half_x;
  const double y0 = scan.center_y_nm - half_y, y1 = scan.center_y_nm + half_y;
  if (std::min(scan.pixel_x_nm, scan.pixel_y_nm) < finest_pixel_nm)
    out.push_back(fmt::format("pixels of {} are finer than surfaces are resolved (0.001 nm)",
                              format_length(std::min(scan.pixel_x_nm, scan.pixel_y_nm))));
  if (beam.tilt_deg != 0) return;  // the comparison of region and specimen below is along z
  const bool bare_plane = specimen.bodies.empty() && !specimen.height_field;
  if (bare_plane) return;
  if (x1 <= extent.lower_nm.x || x0 >= extent.upper_nm.x || y1 <= extent.lower_nm.y ||
      y0 >= extent.upper_nm.y) {
    out.push_back("the scan lies outside the specimen");
    return;
  }
  if (!specimen.height_field) return;
  const HeightField& f = specimen.height_field->field;
  const double beyond = std::max({f.origin_x_nm - x0, x1 - f.x_nm(f.z_nm.width() - 1),
                                  f.origin_y_nm - y0, y1 - f.y_nm(f.z_nm.height() - 1)});
  if (beyond > std::max({f.pitch_x_nm, f.pitch_y_nm, scan.pixel_x_nm, scan.pixel_y_nm}))
    out.push_back(fmt::format("the scan reaches {} beyond the height field, into its continuation",
                              format_length(beyond)));
}

}  // namespace

std::vector<std::string> warn_before(const ResolvedJob& job, const SpecimenFacts& facts,
                                     const mc::Scan& scan) {
  std::vector<std::string> out;
  const mc::Specimen& specimen = job.scene.specimen;
  warn_about_size(facts.extent, out);
  warn_about_transparency(job.scene, facts, out);
  warn_about_bodies(specimen, facts, out);
  warn_about_scan(specimen, facts.extent, job.scene.beam, scan, out);
  if (mc::electrons_of(job.options.budget) == 1)
    out.push_back(
        "one electron per pixel has no scatter: the standard errors are 0 and mean "
        "nothing");
  for (const mc::Material& material : specimen.materials)
    for (std::string& doubt : mc::doubts(material)) out.push_back(std::move(doubt));
  if (mc::is_dielectric(job.scene.physics)) {
    for (const mc::Material& material : specimen.materials)
      for (const mc::EstimatedValue& e : material.dielectric->estimates)
        if (e.field == "energy_loss_function")
          out.push_back(fmt::format(
              "{}: its energy-loss function is an estimate ({}); free paths may be 60 % off",
              material.name, e.rule));
  } else if (job.scene.physics.secondaries)
    for (const mc::Material& material : specimen.materials)
      if (!material.loss_join_fitted)
        out.push_back(material.name +
                      ": no measured yields were used to fit its secondary "
                      "electrons; trust their contrast, not their number");
  return out;
}

std::vector<std::string> warn_after(const mc::SimulationResult& result,
                                    const mc::ResultSummary& summary) {
  std::vector<std::string> out;
  const mc::Balance& b = result.balance;
  if (b.incident > 0 && b.missed == b.incident)
    out.push_back("no pixel of the image sees the specimen");
  const double lost = double(b.total_lost());
  if (lost > lost_fraction * double(b.incident + b.generated)) {
    std::string causes;
    for (int i = 0; i < mc::loss_causes; ++i)
      if (const auto n = b.lost[static_cast<std::size_t>(i)])
        causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", n,
                              mc::name(static_cast<mc::LossCause>(i)));
    out.push_back(fmt::format("{} of {} electrons were given up ({}); is the mesh sound?",
                              b.total_lost(), b.incident + b.generated, causes));
  }
  if (result.complete && summary.missed > 0)
    out.push_back(fmt::format(
        "{} of {} pixels ({:.2g} %) did not reach the accuracy of {}; the worst standard error is "
        "{:.2g} "
        "times what was asked for",
        summary.missed, summary.seen, 100.0 * double(summary.missed) / double(summary.seen),
        format_share(mc::accuracy_of(result.budget)), summary.worst));
  return out;
}

}  // namespace surf::workflow
