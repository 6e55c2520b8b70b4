// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "surf/afm/round_tip.h"
#include "surf/core/units.h"
#include "surf/core/words.h"
#include "surf/io/files.h"
#include "surf/io/model_file.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

using Json = nlohmann::ordered_json;

std::string list_of(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{}", text.empty() ? "" : ",", format_exact(value));
  return text;
}

/// Not finite numbers have no place in JSON.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json file_json(const std::filesystem::path& file) {
  return {{"file", file.string()}, {"sha256", io::sha256_of_file(file)}};
}

Json map_json(const Affine& m) {
  const AffineParts parts = parts_of(m);
  return {{"sem_to_afm", {m.xx, m.xy, m.x0, m.yx, m.yy, m.y0}},
          {"rotation_deg", parts.rotation_rad / degrees_to_radians},
          {"scale_x", parts.scale_x},
          {"scale_y", parts.scale_y},
          {"shear", parts.shear},
          {"shift_nm", {parts.shift_x_nm, parts.shift_y_nm}}};
}

/// Heights at 0, 1, 2 ... steps from the apex, the median over all directions; as far as the tip has samples there.
Json profile_json(const Tip& tip) {
  Json list = Json::array();
  for (const double z : round_profile_nm(tip, 0.5)) list.push_back(number(z));
  return list;
}

Json afm_json(const ReconstructJob& job, const ReconstructSummary& s, const AfmData& afm) {
  const PreparedAfm& p = *s.afm;
  Json json = file_json(job.afm->file);
  json["pixels"] = {afm.image.z_nm.width(), afm.image.z_nm.height()};
  json["pitch_nm"] = {afm.image.pitch_x_nm, afm.image.pitch_y_nm};
  json["tilt_removed_deg"] = p.tilt_deg;
  json["noise"] = {{"from", p.noise_estimate ? "estimated" : "given"}, {"alpha", p.noise.alpha},
                   {"innovation_nm2", p.noise.innovation_nm2}, {"deviation_nm", std::sqrt(p.noise.variance_nm2())}};
  if (p.noise_estimate) {
    json["noise"]["alpha_stderr"] = number(p.noise_estimate->alpha_stderr);
    json["noise"]["innovation_stderr_nm2"] = number(p.noise_estimate->innovation_stderr_nm2);
  }
  json["tip"] = {{"from", p.tip_given ? "given" : p.tip_round ? "blind reconstruction, taken as round" : "blind reconstruction"},
                 {"samples", {p.tip.z_nm.width(), p.tip.z_nm.height()}}};
  if (!p.tip_given) json["tip"]["threshold_nm"] = p.tip_threshold_nm;
  json["tip"]["fitted"] = options_of(job, s).refine_tip;
  json["tip"]["profile_step_nm"] = std::min(p.tip.pitch_x_nm, p.tip.pitch_y_nm);
  json["tip"]["profile_nm"] = profile_json(p.tip);
  if (options_of(job, s).refine_tip) json["tip"]["profile_at_the_end_nm"] = profile_json(s.result.tip);
  json["certainty"] = {{"tolerance_nm", p.certainty.tolerance_nm},
                       {"certain_share", double(p.certainty.certain) / double(std::max<std::size_t>(p.certainty.surface_samples, 1))},
                       {"image_pixels", p.certainty.image_pixels}, {"single", p.certainty.single},
                       {"ambiguous", p.certainty.ambiguous}, {"unexplained", p.certainty.unexplained}};
  json["upsample"] = afm.upsample;
  json["notes"] = p.notes;
  return json;
}

Json sem_json(const ReconstructJob& job, const ReconstructSummary& s, const SemData& sem) {
  Json json = file_json(job.sem->file);
  json["pixels"] = {sem.image.values.width(), sem.image.values.height()};
  json["pixel_nm"] = sem.image.pitch_x_nm;
  json["saturated"] = s.saturated;
  json["noise"] = {{"from", s.sem_noise_from}, {"slope", sem.noise.slope}, {"intercept", sem.noise.intercept},
                   {"least_variance", sem.noise.least_variance}};
  const ModelScope& scope = s.model->trained.scope;
  json["model"] = {{"file", s.model->file.filename().string()}, {"sha256", s.model->sha256},
                   {"kind", io::kind_of(s.model->trained)}, {"material", scope.material}, {"energy_ev", scope.energy_ev},
                   {"spot_nm", scope.spot_nm}, {"pixel_nm", scope.pixel_nm}, {"channels", s.model->model->channels()}};
  json["calibration"] = {{"from", s.calibration ? "the images" : "given"}, {"one_gain_for_all", s.gains_tied}, {"gains", sem.gains}, {"offset", sem.offset}};
  if (s.calibration) {
    Json& c = json["calibration"];
    c["residual_rms"] = number(s.calibration->residual_rms);
    c["explained"] = number(s.calibration->explained);
    c["condition_number"] = number(s.calibration->condition_number);
    c["warnings"] = s.calibration->warnings;
  }
  json["calibration_at_the_end"] = {{"gains", s.result.gains}, {"offset", s.result.offset}};
  return json;
}

Json pose_json(const ReconstructJob& job, const ReconstructSummary& s) {
  const Pose& pose = *s.pose;
  Json json = {{"from", job.pose.transform ? "given" : pose.registration ? "registration" : "landmarks"}};
  json["transform"] = map_json(pose.sem_to_afm);
  json["transform_at_the_end"] = map_json(s.result.sem_to_afm);
  if (pose.landmarks) json["landmarks"] = {{"pairs", job.pose.landmarks.size()}, {"rms_nm", pose.landmarks->rms_nm}};
  if (!pose.registration) return json;
  const Registration& r = *pose.registration;
  json["verdict"] = name(r.verdict);
  json["reason"] = r.reason;
  json["score"] = number(r.score);
  json["stderr_px"] = number(r.stderr_px);
  json["overlap"] = number(r.overlap);
  json["rivals"] = Json::array();
  for (const RegistrationRival& rival : r.rivals) {
    Json one = map_json(rival.sem_to_afm);
    one["score"] = number(rival.score);
    one["distance_px"] = number(rival.distance_px);
    json["rivals"].push_back(one);
  }
  return json;
}

Json residual_json(const ResidualReport& r) {
  return {{"pixels", r.pixels}, {"mean", number(r.mean)}, {"deviation", number(r.deviation)},
          {"correlation_along", number(r.along)}, {"correlation_across", number(r.across)}, {"like_noise", r.like_noise}};
}

Json scales_json(const std::vector<ScaleReport>& scales) {
  Json list = Json::array();
  for (const ScaleReport& s : scales)
    list.push_back({{"sigma_px", s.sigma_px}, {"curvature_prior_per_nm", s.curvature_prior_per_nm}, {"afm", number(s.afm)}, {"sem", number(s.sem)}, {"prior", number(s.prior)},
                    {"gradient_norm", number(s.gradient_norm)}, {"iterations", s.iterations},
                    {"evaluations", s.evaluations}, {"products", s.products}, {"ended", s.ended},
                    {"afm_residual", residual_json(s.afm_residual)}, {"sem_residual", residual_json(s.sem_residual)}});
  return list;
}

Json options_json(const ReconstructionOptions& o, const Reconstruction& r) {
  std::vector<double> scales;
  for (const ScaleReport& s : r.scales) scales.push_back(s.sigma_px);
  return {{"method", name(o.method)}, {"scales_px", scales}, {"iterations", o.iterations}, {"tolerance", o.tolerance},
          {"curvature_prior_per_nm", o.curvature_prior_per_nm}, {"refine_transform", o.refine_transform},
          {"refine_calibration", o.refine_calibration}, {"refine_tip", o.refine_tip}, {"uncertainty", o.uncertainty}, {"probes", o.probes},
          {"seed", o.seed}};
}

/// Shares of the surface by what holds it.
Json held_json(const Grid<unsigned char>& held_by) {
  constexpr const char* names[] = {"nothing", "afm", "sem", "both"};
  Json json = Json::object();
  for (int what = 0; what < 4; ++what)
    json[names[what]] = double(std::ranges::count(held_by.data(), static_cast<unsigned char>(what))) / double(held_by.size());
  return json;
}

}  // namespace

std::vector<std::string> repeating_command(const ReconstructJob& job, const ReconstructSummary& s, const AfmData* afm,
                                           const SemData* sem) {
  const ReconstructionOptions o = options_of(job, s);
  std::vector<std::string> words{"semsurf", "reconstruct"};
  const auto set = [&](const std::string& option) { words.push_back("--" + option); };
  const auto add = [&](const std::string& option, const std::string& value) { set(option), words.push_back(value); };
  if (afm) add("afm", job.afm->file.string());
  if (sem) add("sem", job.sem->file.string());
  words.insert(words.end(), job.fixed_options.begin(), job.fixed_options.end());
  if (afm) {
    add("tip", (job.folder / (o.refine_tip ? "first_tip.txt" : "tip.txt")).string());
    set(o.refine_tip ? "refine-tip" : "keep-tip");
    add("afm-noise", list_of({afm->noise.alpha, afm->noise.innovation_nm2}));
    add("upsample", std::to_string(afm->upsample));
  }
  if (sem) {
    add("model", (job.folder / "model.json").string());
    add("gains", list_of(sem->gains));
    add("offset", format_exact(sem->offset));
    add("sem-noise", list_of({sem->noise.slope, sem->noise.intercept, sem->noise.least_variance}));
  }
  if (afm && sem) {
    const Affine& m = s.pose->sem_to_afm;
    add("transform", list_of({m.xx, m.xy, m.x0, m.yx, m.yy, m.y0}));
  }
  add("method", name(o.method));
  if (!o.scales_px.empty()) add("scales", list_of(o.scales_px));
  if (o.iterations > 0) add("iterations", std::to_string(o.iterations));
  if (o.tolerance > 0) add("tolerance", format_exact(o.tolerance));
  if (o.curvature_prior_per_nm > 0) add("prior", format_exact(o.curvature_prior_per_nm));
  if (!o.refine_transform) set("fixed-transform");
  if (!o.refine_calibration) set("fixed-calibration");
  if (!o.uncertainty) set("no-uncertainty");
  add("probes", std::to_string(o.probes));
  add("seed", std::to_string(o.seed));
  if (!job.truth_file.empty()) add("truth", job.truth_file.string());
  words.insert(words.end(), {"-o", job.folder.string() + "-again"});
  return words;
}

std::string reconstruction_report(const ReconstructJob& job, const ReconstructSummary& s, const AfmData* afm,
                                  const SemData* sem) {
  const Reconstruction& r = s.result;
  Json json;
  json["semsurf"] = version();
  json["libraries"] = library_versions();
  json["command"] = job.command_line;
  json["repeat"] = quoted_command(repeating_command(job, s, afm, sem));
  json["verdict"] = name(s.verdict);
  json["reasons"] = s.reasons;
  json["warnings"] = s.warnings;
  if (afm) json["afm"] = afm_json(job, s, *afm);
  if (sem) json["sem"] = sem_json(job, s, *sem);
  if (s.pose) json["registration"] = pose_json(job, s);
  json["options"] = options_json(options_of(job, s), r);
  json["surface"] = {{"pixels", {r.surface.z_nm.width(), r.surface.z_nm.height()}},
                     {"pitch_nm", {r.surface.pitch_x_nm, r.surface.pitch_y_nm}}, {"converged", r.converged}};
  if (!r.held_by.empty()) json["surface"]["held_by"] = held_json(r.held_by);
  json["scales"] = scales_json(r.scales);
  if (s.truth) {
    const TruthReport& t = *s.truth;
    json["truth"] = file_json(job.truth_file);
    json["truth"].update({{"pixels", t.pixels}, {"rms_nm", t.rms_nm}, {"start_rms_nm", t.start_rms_nm},
                          {"offset_nm", t.offset_nm}, {"plane_rms_nm", t.plane_rms_nm},
                          {"within_1_deviation", t.coverage_1}, {"within_2_deviations", t.coverage_2}});
  }
  // Paths need not be UTF-8: such bytes are replaced rather than the report lost.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace surf::workflow
