// SPDX-License-Identifier: GPL-3.0-or-later
#include "provenance.h"

#include <fmt/format.h>

#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

using Metadata = std::map<std::string, std::string>;

void add_material(Metadata& out, const std::string& key, const mc::Material& material) {
  out[key + ".name"] = material.name;
  out[key + ".density_g_cm3"] = format_exact(material.density_g_cm3);
  out[key + ".work_function_ev"] = format_exact(material.work_function_ev);
  out[key + ".barrier_ev"] = format_exact(material.barrier_ev);
  out[key + ".valence_electrons"] = format_exact(material.valence_electrons);
  out[key + ".plasmon_ev"] = format_exact(material.plasmon_ev);
  out[key + ".loss_join_ev"] = format_exact(material.loss_join_ev);
  out[key + ".loss_join_fitted"] = material.loss_join_fitted ? "true" : "false";
  std::string constituents;
  for (const mc::Constituent& c : material.constituents)
    constituents += fmt::format("{}Z={} A={} weight_fraction={} mean_ionization_ev={}",
                                constituents.empty() ? "" : "; ", c.atomic_number,
                                format_exact(c.atomic_weight), format_exact(c.weight_fraction),
                                format_exact(c.mean_ionization_ev));
  out[key + ".constituents"] = constituents;
  out[key + ".formula_weight_g_mol"] = format_exact(material.formula_weight_g_mol);
  for (const mc::EstimatedValue& e : material.estimates)
    out[key + ".estimated." + e.field] = e.rule;
  if (!material.sources.empty()) out[key + ".sources"] = material.sources;
}

const char* edge_name(Edge edge) {
  switch (edge) {
    case Edge::mirror:
      return "mirror";
    case Edge::flat:
      return "flat";
    case Edge::periodic:
      return "periodic";
  }
  return "";
}

std::string file_name(const std::string& name) {
  return std::filesystem::path(name).filename().string();
}

void add_specimen(Metadata& out, const mc::Specimen& specimen) {
  const auto material = [&](int index) {
    return specimen.materials.at(static_cast<std::size_t>(index)).name;
  };
  if (const auto& s = specimen.substrate)
    out["specimen.substrate"] =
        fmt::format("{}, top at {} nm", material(s->material), format_exact(s->top_nm));
  if (const auto& h = specimen.height_field) {
    const HeightField& f = h->field;
    out["specimen.height_field"] =
        fmt::format("{}, {}, {}x{} samples, pitch {} x {} nm, origin {}, {} nm, edge {}",
                    file_name(h->name), material(h->material), f.z_nm.width(), f.z_nm.height(),
                    format_exact(f.pitch_x_nm), format_exact(f.pitch_y_nm),
                    format_exact(f.origin_x_nm), format_exact(f.origin_y_nm), edge_name(h->edge));
  }
  int number = 0;
  for (const mc::Body& body : specimen.bodies) {
    const Box box = bounds(body.mesh);
    out[fmt::format("specimen.body.{}", ++number)] = fmt::format(
        "{}, {}, {} triangles, from {}, {}, {} to {}, {}, {} nm", file_name(body.name),
        material(body.material), body.mesh.triangles.size(), format_exact(box.lower_nm.x),
        format_exact(box.lower_nm.y), format_exact(box.lower_nm.z), format_exact(box.upper_nm.x),
        format_exact(box.upper_nm.y), format_exact(box.upper_nm.z));
  }
}

}  // namespace

std::vector<InputHash> hash_inputs(const std::vector<std::filesystem::path>& inputs) {
  std::vector<InputHash> hashes;
  for (const auto& path : inputs) hashes.push_back({path, io::sha256_of_file(path)});
  return hashes;
}

Metadata parameters_of(const ResolvedJob& job) {
  mc::SimulationRequest request = job.scene;  // with the values that were found
  request.method = job.options.method;
  request.budget = job.options.budget;
  request.detectors.clear();  // detectors are described separately
  request.scan = {};
  return surf::record_of(request);
}

Metadata provenance(const ResolvedJob& job, const mc::Scan& scan,
                    const std::vector<InputHash>& inputs) {
  Metadata out;
  out["semsurf.version"] = version();
  if (!job.scene.title.empty()) out["title"] = job.scene.title;
  int number = 0;
  for (const InputHash& input : inputs)
    out[fmt::format("input.{}", ++number)] =
        fmt::format("{} sha256 {}", input.path.filename().string(), input.sha256);
  out.merge(parameters_of(job));
  out.merge(surf::record_of(job.estimate));
  out.merge(surf::record_of(scan));
  if (const double dose = mc::dose_of(job.options.budget); dose > 0)
    out["simulation.dose"] = format_exact(dose);
  add_specimen(out, job.scene.specimen);
  number = 0;
  for (const auto& [file, unit_nm] : job.scene.unit_overrides)
    out[fmt::format("unit_override.{}", ++number)] =
        fmt::format("{}, {} nm", file, format_exact(unit_nm));
  number = 0;
  for (const mc::Material& material : job.scene.specimen.materials) {
    const std::string key = fmt::format("material.{}", ++number);
    add_material(out, key, material);
    out[key + ".cutoff_ev"] = format_exact(mc::effective_cutoff_ev(job.scene.physics, material));
  }
  number = 0;
  for (const mc::Detector& d : job.options.detectors)
    out[fmt::format("detector.{}", ++number)] = mc::format_detector(d);
  // With deposited energy, tracks are followed to their end, with other random numbers.
  if (job.extras.deposit_cells > 0)
    out["output.deposit"] = std::to_string(job.extras.deposit_cells);
  return out;
}

Metadata output_settings(const ResolvedJob& job) {
  SimulateJob said = job, usual;
  Metadata out, defaults;
  const auto keep = [](Metadata& to) {
    return [&to](const Parameter& about, Field& field) {
      if (about.recorded && about.name.starts_with("output.") && field.given())
        to[about.key()] = field.text();
    };
  };
  for_each_parameter(said, keep(out));
  for_each_parameter(usual, keep(defaults));
  std::erase_if(out, [&](const auto& one) {
    const auto found = defaults.find(one.first);
    return found != defaults.end() && found->second == one.second;
  });
  return out;
}

Metadata outcome(const SimulateSummary& summary) {
  Metadata out;
  const mc::SimulationResult& result = summary.result;
  const mc::Balance& b = result.balance;
  out["balance.incident"] = std::to_string(b.incident);
  out["balance.missed"] = std::to_string(b.missed);
  out["balance.generated"] = std::to_string(b.generated);
  out["balance.se"] = std::to_string(b.se);
  out["balance.bse"] = std::to_string(b.bse);
  out["balance.transmitted"] = std::to_string(b.transmitted);
  out["balance.absorbed"] = std::to_string(b.absorbed);
  out["balance.lost"] = std::to_string(b.total_lost());
  int body = 0;
  for (const SimplifiedBody& done : summary.simplification.bodies)
    out[fmt::format("simplified.{}", ++body)] = describe(done);
  if (result.library_cascades > 0) {
    out["library.cascades"] = std::to_string(result.library_cascades);
    out["balance.handed_over"] = std::to_string(b.handed_over);
  }
  for (int i = 0; i < mc::pixel_models; ++i)
    if (const auto n = summary.statistics.models[static_cast<std::size_t>(i)])
      out[fmt::format("pixels.{}", mc::name(static_cast<mc::PixelModel>(i)))] = std::to_string(n);
  if (!result.complete) out["partial"] = "true";
  int number = 0;
  for (const std::string& warning : summary.warnings)
    out[fmt::format("warning.{}", ++number)] = warning;
  return out;
}

}  // namespace surf::workflow
