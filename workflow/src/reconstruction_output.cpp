// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "reconstruction_panel.h"
#include "reconstruction_report.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/model/model_file.h"
#include "surf/io/plot.h"
#include "surf/io/surface_file.h"
#include "surf/io/tip_file.h"
#include "surf/io/transform_file.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/workflow/step_record.h"
#include "view_preparation.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using Metadata = std::map<std::string, std::string>;

std::string hash_of(const Grid<double>& values) {
  return io::sha256_of(std::as_bytes(std::span(values.data())));
}

/// The provenance of a file, which is the same for a run that is repeated from the report. `model`
/// is the model's file as written.
Metadata made_by(const ReconstructJob& job, const ReconstructSummary& s, const AfmData* afm,
                 const SemData* sem, const fs::path& model) {
  std::vector<fs::path> inputs;
  if (job.afm) inputs.push_back(job.afm->file);
  if (job.sem) inputs.push_back(job.sem->file);
  for (const SemInput& view : job.views) inputs.push_back(view.file);
  Metadata made = step_record("reconstruct", record_of(parameters_used(job, s, afm, sem)), inputs);
  if (afm)
    made["tip"] = fmt::format("{} x {} samples, sha256 {}", afm->tip.z_nm.width(),
                              afm->tip.z_nm.height(), hash_of(afm->tip.z_nm));
  if (!sem) return made;
  made["model"] = fmt::format("{} sha256 {}", model.filename().string(), io::sha256_of_file(model));
  const ModelScope& scope = s.model->trained.scope;
  if (!scope.material.empty()) made["material.1.name"] = scope.material;
  if (scope.energy_ev > 0) made["beam.energy_ev"] = format_exact(scope.energy_ev);
  made["beam.spot_nm"] = format_exact(scope.spot_nm);
  return made;
}

template <class T>
Channel channel(const std::string& name, const std::string& unit, const Grid<T>& values) {
  Channel c{name, unit, Grid<float>(values.width(), values.height())};
  std::ranges::transform(values.data(), c.values.data().begin(),
                         [](T v) { return static_cast<float>(v); });
  return c;
}

/// A mask, or 1 everywhere.
Channel valid_channel(const Mask& valid, int width, int height) {
  return channel("valid", "1", valid.empty() ? Mask(width, height, 1) : valid);
}

Image placed_like(const Placement& placement, const Metadata& made) {
  Image image;
  image.placement() = placement;
  image.metadata = made;
  return image;
}

/// The certainty of the scan at the surface's samples: 1 where the eroded scan is the surface, 0
/// where it may lie above the surface.
Mask certain_on(const HeightField& surface, const CertaintyMap& map, const Affine& to_afm) {
  Mask certain(surface.z_nm.width(), surface.z_nm.height());
  const HeightField& scan = map.surface;
  for (int y = 0; y < certain.height(); ++y)
    for (int x = 0; x < certain.width(); ++x) {
      const Point2 p = to_afm({surface.x_nm(x), surface.y_nm(y)});
      const double column = std::round((p.x - scan.origin_x_nm) / scan.pitch_x_nm);
      const double row = std::round((p.y - scan.origin_y_nm) / scan.pitch_y_nm);
      if (!(column >= 0 && row >= 0 && column < scan.z_nm.width() && row < scan.z_nm.height()))
        continue;
      certain(x, y) =
          map.level(static_cast<int>(column), static_cast<int>(row)) != CertaintyMap::uncertain;
    }
  return certain;
}

/// A surface and everything known about its heights.
Image surface_image(const ReconstructSummary& s, const Reconstruction& r, const Metadata& made) {
  Image image = placed_like(r.surface, made);
  image.channels.push_back(channel("z_nm", "nm", r.surface.z_nm));
  if (!r.deviation_nm.empty())
    image.channels.push_back(channel("deviation_nm", "nm", r.deviation_nm));
  if (!r.lower_nm.empty()) {
    image.channels.push_back(channel("lower_nm", "nm", r.lower_nm));
    image.channels.push_back(channel("upper_nm", "nm", r.upper_nm));
  }
  if (!r.data_support.empty())
    image.channels.push_back(channel("data_support", "1", r.data_support));
  if (s.afm)
    image.channels.push_back(channel(
        "certain", "1", certain_on(r.surface, s.afm->certainty, s.pose ? r.sem_to_afm : Affine{})));
  if (!r.start.z_nm.empty() && r.start.z_nm.size() == r.surface.z_nm.size())
    image.channels.push_back(channel("start_nm", "nm", r.start.z_nm));
  image.channels.push_back(
      valid_channel(r.surface.valid, r.surface.z_nm.width(), r.surface.z_nm.height()));
  return image;
}

SurfaceScene surface_scene(const Reconstruction& r, const Metadata& made) {
  SurfaceScene scene;
  scene.metadata = made;
  Surface surface;
  surface.name = "reconstruction";
  surface.mesh = height_field_sheet(r.surface);
  const auto scalar = [&](const std::string& name, const std::string& unit, const auto& values) {
    VertexScalar v{name, unit, {}};
    for (const auto value : values.data()) v.values.push_back(static_cast<float>(value));
    surface.scalars.push_back(std::move(v));
  };
  if (!r.deviation_nm.empty()) scalar("deviation", "nm", r.deviation_nm);
  scalar("height", "nm", r.surface.z_nm);
  if (!r.data_support.empty()) scalar("data_support", "1", r.data_support);
  scene.surfaces.push_back(std::move(surface));
  return scene;
}

Image afm_image(const Reconstruction& r, const AfmData& afm, const Metadata& made) {
  Image image = placed_like(afm.image, made);
  image.channels = {
      channel("simulated_nm", "nm", r.simulated_afm.z_nm), channel("scan_nm", "nm", afm.image.z_nm),
      channel("residual", "1", r.afm_residual), channel("used", "1", r.afm_used),
      valid_channel(r.simulated_afm.valid, afm.image.z_nm.width(), afm.image.z_nm.height())};
  return image;
}

Image sem_image(const Reconstruction& r, const SemData& sem, const Metadata& made) {
  Image image = placed_like(r.surface, made);
  image.channels = {
      channel("simulated", "1", r.simulated_sem), channel("sem", "1", sem.image.values),
      channel("residual", "1", r.sem_residual),
      valid_channel(sem.image.valid, r.simulated_sem.width(), r.simulated_sem.height())};
  if (!r.sem_discrepancy.empty())
    image.channels.push_back(channel("discrepancy", "1", r.sem_discrepancy));
  return image;
}

Image view_image(const ViewResult& r, const SemView& view, const Metadata& made) {
  Image image = placed_like(view.sem.image, made);
  image.metadata["beam.tilt_deg"] = format_exact(r.pose.tilt_deg);
  image.metadata["beam.azimuth_deg"] = format_exact(r.pose.azimuth_deg);
  image.channels = {channel("simulated", "1", r.simulated),
                    channel("sem", "1", view.sem.image.values),
                    channel("residual", "1", r.residual), channel("used", "1", r.used),
                    valid_channel(view.sem.image.valid, r.simulated.width(), r.simulated.height())};
  return image;
}

void append(std::string& line, const ResidualReport& r) {
  line += fmt::format(",{},{},{},{},{}", format_exact(r.mean), format_exact(r.deviation),
                      format_exact(r.along), format_exact(r.across), r.like_noise ? 1 : 0);
}

}  // namespace

std::string history_text(const std::vector<ScaleReport>& scales) {
  std::string text =
      "sigma_px,curvature_prior_per_nm,afm,sem,prior,gradient_norm,iterations,evaluations,products,"
      "ended";
  for (const char* image : {"afm", "sem"})
    for (const char* what : {"mean", "deviation", "along", "across", "like_noise"})
      text += fmt::format(",{}_{}", image, what);
  text += '\n';
  for (const ScaleReport& s : scales) {
    std::string line =
        fmt::format("{},{},{},{},{},{},{},{},{},{}", format_exact(s.sigma_px),
                    format_exact(s.curvature_prior_per_nm), format_exact(s.afm),
                    format_exact(s.sem), format_exact(s.prior), format_exact(s.gradient_norm),
                    s.iterations, s.evaluations, s.products, s.ended);
    append(line, s.afm_residual);
    append(line, s.sem_residual);
    text += line + "\n";
  }
  return text;
}

std::vector<fs::path> reconstruction_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const char* name : {"surface.vti", "surface.gsf", "surface.glb", "simulated_afm.vti",
                           "simulated_sem.vti", "rival.vti", "rival_transform.json", "tip.txt",
                           "first_tip.txt", "model.json", "transform.json", "registration.png",
                           "history.csv", "panel.png", "report.json", "checkpoint"})
    files.push_back(folder / name);
  for (std::size_t k = 2; k < most_views + 2; ++k) {
    files.push_back(folder / fmt::format("simulated_sem{}.vti", k));
    files.push_back(folder / fmt::format("model{}.json", k));
  }
  return files;
}

std::vector<fs::path> write_reconstruction(const ReconstructJob& job, const ReconstructSummary& s,
                                           const AfmData* afm, const SemData* sem,
                                           const std::vector<SemView>& views) {
  const Reconstruction& r = s.result;
  std::vector<fs::path> written;
  const auto file = [&](const std::string& name) {
    written.push_back(job.folder / name);
    return written.back();
  };
  const fs::path model = job.folder / "model.json";
  if (sem) io::write_model(model, s.model->trained);
  const Metadata made = made_by(job, s, afm, sem, model);
  io::write_image(file("surface.vti"), surface_image(s, r, made));
  io::write_height_field(file("surface.gsf"), r.surface, made);
  io::write_surfaces(file("surface.glb"), surface_scene(r, made));
  if (afm) {
    io::write_image(file("simulated_afm.vti"), afm_image(r, *afm, made));
    io::write_tip(file("tip.txt"), r.tip, made);
    if (options_of(job, s).refine_tip) io::write_tip(file("first_tip.txt"), afm->tip, made);
  }
  if (sem) {
    io::write_image(file("simulated_sem.vti"), sem_image(r, *sem, made));
    written.push_back(model);
  }
  for (std::size_t k = 0; k < views.size(); ++k) {
    io::write_image(file(fmt::format("simulated_sem{}.vti", k + 2)),
                    view_image(r.views[k], views[k], made));
    const std::string own = view_model_name(s, k);
    if (own != "model.json") io::write_model(file(own), s.views[k].model.trained);
  }
  if (afm && sem) {
    io::TransformFile transform;
    transform.sem_to_afm = r.sem_to_afm;
    transform.verified = s.pose->verified();
    transform.notes = made;
    transform.verdict = "as it is after the reconstruction";
    io::write_transform(file("transform.json"), transform);
  }
  if (s.rival) {
    io::write_image(file("rival.vti"), surface_image(s, s.rival->found, made));
    io::TransformFile transform;
    transform.sem_to_afm = s.rival->found.sem_to_afm;
    transform.verified = false;
    transform.notes = made;
    transform.verdict = fmt::format("a rival with a probability of {:.2g}", s.rival->probability);
    io::write_transform(file("rival_transform.json"), transform);
  }
  io::write_text(file("history.csv"), history_text(r.scales));
  if (job.picture) {
    io::Plot panel = reconstruction_panel(job, s, afm, sem, views);
    panel.metadata = made;
    io::write_plot(file("panel.png"), panel);
  }
  io::write_text(file("report.json"), reconstruction_report(job, s, afm, sem));
  return written;
}

}  // namespace surf::workflow
