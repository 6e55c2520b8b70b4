// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common_parameters.h"
#include "surf/afm/round_tip.h"
#include "surf/core/command_words.h"
#include "surf/core/units.h"
#include "surf/core/words.h"
#include "surf/io/files.h"
#include "surf/io/model/model_file.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

using Json = nlohmann::ordered_json;

/// A number, or null if it is not finite, as JSON requires.
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

Json map_deviation_json(const MapDeviation& d) {
  return {{"rotation_deg", number(d.rotation_rad / degrees_to_radians)},
          {"scale_x", number(d.scale_x)},
          {"scale_y", number(d.scale_y)},
          {"shear", number(d.shear)},
          {"middle_nm", {number(d.middle_x_nm), number(d.middle_y_nm)}}};
}

/// The tip's heights at 0, 1, 2 ... steps from the apex, as medians over all directions, as far as
/// the tip has samples.
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
  if (s.pose)
    json["tilt_by_sem"] = {{"slopes", {s.tilt.x, s.tilt.y}},
                           {"standard_errors", {s.tilt.doubt.x, s.tilt.doubt.y}}};
  json["noise"] = {{"from", p.noise_estimate ? "estimated" : "given"},
                   {"alpha", p.noise.alpha},
                   {"innovation_nm2", p.noise.innovation_nm2},
                   {"deviation_nm", std::sqrt(p.noise.variance_nm2())}};
  if (p.noise_estimate) {
    json["noise"]["alpha_stderr"] = number(p.noise_estimate->alpha_stderr);
    json["noise"]["innovation_stderr_nm2"] = number(p.noise_estimate->innovation_stderr_nm2);
  }
  json["tip"] = {
      {"from", p.tip_given      ? "given"
               : p.tip_from_sem ? "the SEM image: the tip whose eroded scan explains it best"
               : p.tip_round    ? "blind reconstruction, taken as round"
                                : "blind reconstruction"},
      {"samples", {p.tip.z_nm.width(), p.tip.z_nm.height()}}};
  if (!p.tip_given) json["tip"]["threshold_nm"] = p.tip_threshold_nm;
  json["tip"]["fitted"] = options_of(job, s).refine_tip;
  json["tip"]["profile_step_nm"] = std::min(p.tip.pitch_x_nm, p.tip.pitch_y_nm);
  json["tip"]["profile_nm"] = profile_json(p.tip);
  if (options_of(job, s).refine_tip)
    json["tip"]["profile_at_the_end_nm"] = profile_json(s.result.tip);
  json["certainty"] = {
      {"tolerance_nm", p.certainty.tolerance_nm},
      {"certain_share",
       double(p.certainty.certain) / double(std::max<std::size_t>(p.certainty.surface_samples, 1))},
      {"image_pixels", p.certainty.image_pixels},
      {"single", p.certainty.single},
      {"ambiguous", p.certainty.ambiguous},
      {"unexplained", p.certainty.unexplained}};
  json["upsample"] = afm.upsample;
  json["notes"] = p.notes;
  return json;
}

Json sem_json(const ReconstructJob& job, const ReconstructSummary& s, const SemData& sem) {
  Json json = file_json(job.sem->file);
  json["pixels"] = {sem.image.values.width(), sem.image.values.height()};
  json["pixel_nm"] = sem.image.pitch_x_nm;
  json["saturated"] = s.saturated;
  json["noise"] = {{"from", s.sem_noise_from},
                   {"slope", sem.noise.slope},
                   {"intercept", sem.noise.intercept},
                   {"least_variance", sem.noise.least_variance}};
  const ModelScope& scope = s.model->trained.scope;
  json["model"] = {{"file", s.model->file.filename().string()},
                   {"sha256", s.model->sha256},
                   {"kind", io::kind_of(s.model->trained)},
                   {"material", scope.material},
                   {"energy_ev", scope.energy_ev},
                   {"spot_nm", scope.spot_nm},
                   {"pixel_nm", scope.pixel_nm},
                   {"channels", s.model->model->channels()}};
  json["calibration"] = {{"from", s.calibration ? "the images" : "given"},
                         {"one_gain_for_all", s.gains_tied},
                         {"gains", sem.gains},
                         {"offset", sem.offset}};
  if (s.calibration) {
    Json& c = json["calibration"];
    c["residual_rms"] = number(s.calibration->residual_rms);
    c["explained"] = number(s.calibration->explained);
    c["condition_number"] = number(s.calibration->condition_number);
    c["warnings"] = s.calibration->warnings;
  }
  json["calibration_at_the_end"] = {
      {"gains", s.result.gains}, {"offset", s.result.offset}, {"blur_px2", s.result.blur_px2}};
  if (sem.film) {
    json["film"] = {{"material", sem.film->material},
                    {"thickness_nm", s.result.film_nm},
                    {"relative_change_per_nm", sem.film->per_nm}};
  }
  if (options_of(job, s).refine_drift)
    json["scan_drift_px"] = {s.result.scan_drift_px.x, s.result.scan_drift_px.y};
  return json;
}

Json residual_json(const ResidualReport& r) {
  return {{"pixels", r.pixels},
          {"mean", number(r.mean)},
          {"deviation", number(r.deviation)},
          {"correlation_along", number(r.along)},
          {"correlation_across", number(r.across)},
          {"like_noise", r.like_noise}};
}

Json views_json(const ReconstructJob& job, const ReconstructSummary& s) {
  Json list = Json::array();
  for (std::size_t k = 0; k < s.views.size(); ++k) {
    const PreparedView& v = s.views[k];
    Json json = file_json(job.views[k].file);
    json["tilt_deg"] = v.tilt_deg;
    json["azimuth_deg"] = v.azimuth_deg;
    if (!v.signal.empty()) json["signal"] = v.signal;
    if (!job.views[k].reading.channel.empty()) json["channel"] = job.views[k].reading.channel;
    json["model"] = {{"file", view_model_name(s, k)},
                     {"sha256", v.model.sha256},
                     {"energy_ev", v.model.trained.scope.energy_ev}};
    json["place"] = {{"shift_nm", {v.shift_x_nm, v.shift_y_nm}}, {"correlation", v.correlation}};
    json["calibration"] = {{"gains", v.gains}, {"offset", v.offset}};
    json["noise"] = {{"from", v.noise_from},
                     {"slope", v.noise.slope},
                     {"intercept", v.noise.intercept},
                     {"least_variance", v.noise.least_variance}};
    json["saturated"] = v.saturated;
    if (k < s.result.views.size()) {
      const ViewResult& r = s.result.views[k];
      const Affine& m = r.pose.to_plane;
      json["at_the_end"] = {{"tilt_deg", r.pose.tilt_deg},
                            {"azimuth_deg", r.pose.azimuth_deg},
                            {"image_to_plane", {m.xx, m.xy, m.x0, m.yx, m.yy, m.y0}},
                            {"gains", r.gains},
                            {"offset", r.offset},
                            {"discrepancy_share", r.discrepancy_share},
                            {"residual", residual_json(r.statistics)}};
    }
    list.push_back(json);
  }
  return list;
}

Json pose_json(const ReconstructJob& job, const ReconstructSummary& s) {
  const Pose& pose = *s.pose;
  Json json = {{"from", job.pose.transform  ? "given"
                        : pose.registration ? "registration"
                                            : "landmarks"}};
  json["transform"] = map_json(pose.sem_to_afm);
  json["transform_at_the_end"] = map_json(s.result.sem_to_afm);
  if (s.result.map_deviation)
    json["transform_at_the_end"]["standard_error"] = map_deviation_json(*s.result.map_deviation);
  if (pose.landmarks)
    json["landmarks"] = {{"pairs", job.pose.landmarks.size()}, {"rms_nm", pose.landmarks->rms_nm}};
  if (!pose.registration) return json;
  const Registration& r = *pose.registration;
  json["verdict"] = name(r.verdict);
  json["reason"] = r.reason;
  json["score"] = number(r.score);
  json["stderr_px"] = number(r.stderr_px);
  json["slides"] = r.slides;
  json["overlap"] = number(r.overlap);
  json["rivals"] = Json::array();
  for (const RegistrationRival& rival : r.rivals) {
    Json one = map_json(rival.sem_to_afm);
    one["score"] = number(rival.score);
    one["distance_px"] = number(rival.distance_px);
    json["rivals"].push_back(one);
  }
  for (const JudgedPlace& place : pose.places) {
    Json one = map_json(place.sem_to_afm);
    one["disagreement"] = number(place.disagreement);
    one["probability"] = number(place.probability);
    one["explained"] = place.explained;
    json["judged_by_both_images"].push_back(one);
  }
  if (s.rival)
    json["rival_surface"] = {{"probability", number(s.rival->probability)},
                             {"share_of_heights_apart", number(s.rival->share_apart)},
                             {"transform", map_json(s.rival->found.sem_to_afm)}};
  return json;
}

Json scales_json(const std::vector<ScaleReport>& scales) {
  Json list = Json::array();
  for (const ScaleReport& s : scales)
    list.push_back({{"sigma_px", s.sigma_px},
                    {"curvature_prior_per_nm", s.curvature_prior_per_nm},
                    {"afm", number(s.afm)},
                    {"sem", number(s.sem)},
                    {"prior", number(s.prior)},
                    {"gradient_norm", number(s.gradient_norm)},
                    {"iterations", s.iterations},
                    {"evaluations", s.evaluations},
                    {"products", s.products},
                    {"factors", s.factors},
                    {"factors_in_double_precision", s.double_factors},
                    {"ended", s.ended},
                    {"afm_residual", residual_json(s.afm_residual)},
                    {"sem_residual", residual_json(s.sem_residual)}});
  return list;
}

/// All parameters by name, with numbers as JSON numbers.
Json options_json(ReconstructJob used) {
  Json json = Json::object();
  for_each_parameter(used, [&](const Parameter& about, Field& field) {
    if (!about.recorded || !field.given()) return;
    const std::string text = field.text();
    if (field.kind() == FieldKind::flag) json[about.key()] = text == "on";
    else if (field.kind() == FieldKind::number || field.kind() == FieldKind::whole)
      json[about.key()] = Json::parse(text);
    else json[about.key()] = text;
  });
  return json;
}

/// Shares of the surface by data support.
Json held_json(const Grid<unsigned char>& data_support) {
  constexpr const char* names[] = {"nothing", "afm", "sem", "both"};
  Json json = Json::object();
  for (int what = 0; what < 4; ++what)
    json[names[what]] =
        double(std::ranges::count(data_support.data(), static_cast<unsigned char>(what))) /
        double(data_support.size());
  return json;
}

}  // namespace

std::string view_model_name(const ReconstructSummary& s, std::size_t view) {
  return s.model && s.views[view].model.sha256 == s.model->sha256
             ? "model.json"
             : fmt::format("model{}.json", view + 2);
}

ReconstructJob parameters_of(const ReconstructJob& job) {
  ReconstructJob out;
  if (job.afm) {
    out.afm.emplace();
    out.afm->reading = job.afm->reading;
    out.afm->preparation = job.afm->preparation;
    out.afm->preparation.tip.reset();
  }
  if (job.sem) {
    out.sem.emplace();
    out.sem->reading = job.sem->reading;
  }
  out.view_settings = job.view_settings;
  out.known_views = job.known_views;
  out.model = job.model;
  out.pose = job.pose;
  out.calibration = job.calibration;
  out.sem_noise = job.sem_noise;
  out.model_error = job.model_error;
  out.line_jitter_px = job.line_jitter_px;
  out.film = job.film;
  out.tilt = job.tilt;
  out.corrections = job.corrections;
  out.correction_electrons = job.correction_electrons;
  out.upsample = job.upsample;
  out.refine_tip = job.refine_tip;
  out.options = job.options;
  return out;
}

ReconstructJob parameters_used(const ReconstructJob& job, const ReconstructSummary& s,
                               const AfmData* afm, const SemData* sem) {
  ReconstructJob used = parameters_of(job);
  used.model = {};
  used.model.signal = job.model.signal;
  used.pose = {};
  used.pose.accept_unverified = job.pose.accept_unverified;
  used.options = options_of(job, s);
  if (afm) {
    used.afm->preparation.noise = afm->noise;
    used.afm->preparation.tip_size = 0;
    used.refine_tip = used.options.refine_tip;
  }
  if (sem) {
    used.calibration = {sem->gains, sem->offset};
    used.sem_noise = sem->noise;
  }
  KnownViews& views = used.known_views;
  views.gains.clear(), views.noises.clear(), views.places_nm.clear();
  for (const PreparedView& view : s.views) {
    views.gains.push_back(view.gains);
    views.gains.back().push_back(view.offset);
    views.noises.push_back(view.noise);
    views.places_nm.push_back({view.shift_x_nm, view.shift_y_nm});
  }
  if (afm && sem) {
    used.pose.transform = s.pose->sem_to_afm;
    used.tilt = s.tilt;
  }
  return used;
}

std::vector<std::string> repeating_command(const ReconstructJob& job, const ReconstructSummary& s,
                                           const AfmData* afm, const SemData* sem) {
  ReconstructJob used = parameters_used(job, s, afm, sem), usual;
  std::vector<std::string> words{"semsurf", "reconstruct"};
  const auto add = [&](const std::string& option, const std::string& value) {
    words.insert(words.end(), {"--" + option, value});
  };
  if (afm) {
    add("afm", job.afm->file.string());
    add("tip", (job.folder / (used.options.refine_tip ? "first_tip.txt" : "tip.txt")).string());
    add("afm-noise", exact_list({afm->noise.alpha,
                                 afm->noise.innovation_nm2}));  // exact, unlike scan.height_noise
    used.afm->preparation.noise.reset();
    usual.afm.emplace();
  }
  if (sem) {
    add("sem", job.sem->file.string());
    for (const SemInput& view : job.views)
      add("sem", view.reading.channel.empty()
                     ? view.file.string()
                     : fmt::format("{}:{}", view.file.string(), view.reading.channel));
    add("model", (job.folder / "model.json").string());
    for (std::size_t k = 0; k < job.views.size(); ++k)
      add("view-model", (job.folder / view_model_name(s, k)).string());
    usual.sem.emplace();
    used.known_views.models.clear();
    used.view_settings.energies_ev.clear();
  }
  const OptionNames names{{"level.method", "--level-method"},
                          {"level.degree", "--level-degree"},
                          {"level.tolerance", "--level-tolerance"}};
  const std::vector<std::string> changed = command_words(used, usual, names);
  words.insert(words.end(), changed.begin(), changed.end());
  if (!job.truth_file.empty()) add("truth", job.truth_file.string());
  words.insert(words.end(), {"-o", job.folder.string() + "-again"});
  return words;
}

std::string reconstruction_report(const ReconstructJob& job, const ReconstructSummary& s,
                                  const AfmData* afm, const SemData* sem) {
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
  if (!s.views.empty()) json["views"] = views_json(job, s);
  if (s.pose) json["registration"] = pose_json(job, s);
  json["options"] = options_json(parameters_used(job, s, afm, sem));
  json["surface"] = {{"pixels", {r.surface.z_nm.width(), r.surface.z_nm.height()}},
                     {"pitch_nm", {r.surface.pitch_x_nm, r.surface.pitch_y_nm}},
                     {"converged", r.converged}};
  if (!r.sem_row_jitter.empty()) {
    double squares = 0;
    for (const double size : r.sem_row_jitter) squares += size * size;
    json["line_jitter"] = {
        {"allowed_px", job.line_jitter_px},
        {"found_px",
         job.line_jitter_px * std::sqrt(squares / static_cast<double>(r.sem_row_jitter.size()))}};
  }
  if (!r.sem_discrepancy.empty())
    json["discrepancy"] = {{"allowed_share", job.model_error},
                           {"share_of_contrast", r.sem_discrepancy_share}};
  for (const CorrectionRound& round : s.corrections)
    json["corrections"].push_back({{"channels", s.model->model->channels()},
                                   {"off_share", round.off_share},
                                   {"error_share", round.error_share},
                                   {"moved_nm", round.moved_nm},
                                   {"primaries", round.primaries}});
  if (!r.data_support.empty()) {
    json["surface"]["data_support"] = held_json(r.data_support);
    json["surface"]["held"] = s.held;
  }
  json["scales"] = scales_json(r.scales);
  if (s.truth) {
    const TruthReport& t = *s.truth;
    json["truth"] = file_json(job.truth_file);
    json["truth"].update({{"pixels", t.pixels},
                          {"rms_nm", t.rms_nm},
                          {"start_rms_nm", t.start_rms_nm},
                          {"offset_nm", t.offset_nm},
                          {"plane_rms_nm", t.plane_rms_nm},
                          {"within_1_deviation", t.coverage_1},
                          {"within_2_deviations", t.coverage_2},
                          {"within_interval", t.in_interval}});
    for (const RegionReport& region : t.regions)
      json["truth"]["regions"][region.name] = {{"pixels", region.pixels},
                                               {"rms_nm", region.rms_nm},
                                               {"deviation_nm", region.stated_nm},
                                               {"within_1_deviation", region.coverage_1},
                                               {"within_2_deviations", region.coverage_2},
                                               {"within_interval", region.in_interval}};
  }
  // Paths need not be UTF-8. Such bytes are replaced, so that the report is not lost.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace surf::workflow
