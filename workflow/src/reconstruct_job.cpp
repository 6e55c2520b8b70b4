// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/reconstruct_job.h"

#include <fmt/format.h>
#include <algorithm>

#include <cmath>
#include <span>

#include "chain_steps.h"
#include "common_parameters.h"
#include "compare_truth.h"
#include "correct_and_reconstruct.h"
#include "film_effect.h"
#include "first_calibration.h"
#include "job_identity.h"
#include "judge_places.h"
#include "place_doubt.h"
#include "reconstruction_checkpoint.h"
#include "reconstruction_output.h"
#include "reconstruction_report.h"
#include "registration_picture.h"
#include "seen_from.h"
#include "sem_frame.h"
#include "sem_preparation.h"
#include "surf/core/error.h"
#include "surf/core/instruction_set.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/plot.h"
#include "surf/io/sim/materials.h"
#include "surf/io/transform_file.h"
#include "surf/reconstruction/tip_search.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/version.h"
#include "tip_with_sem.h"
#include "view_preparation.h"
#include "what_held.h"

namespace surf::workflow {
namespace {

constexpr double least_deviation = 0.9, largest_deviation = 1.15,
                 largest_correlation = 0.1;  // of whitened residuals

template <class T>
std::string hash_of(const std::vector<T>& values) {
  return io::sha256_of(std::as_bytes(std::span(values)));
}

std::string map_text(const Affine& m) { return exact_list({m.xx, m.xy, m.x0, m.yx, m.yy, m.y0}); }

/// What a state depends on of an SEM image; keys begin with `of`.
void add_image(const std::string& of, const SemData& sem, const StoredModel& model, Identity& id) {
  const PlacedImage& image = sem.image;
  id[of] = hash_of(image.values.data()) + hash_of(image.valid.data()) +
           exact_list({image.pitch_x_nm, image.pitch_y_nm, image.origin_x_nm, image.origin_y_nm});
  const std::string prefix = of == "SEM image" ? "" : of + "'s ";
  id[prefix + "model"] = model.sha256;
  for (const std::string& channel : model.model->channels()) id[prefix + "signal"] += channel + " ";
  id[prefix + "gains"] = exact_list(sem.gains);
  id[prefix + "offset"] = format_exact(sem.offset);
  id[prefix + (prefix.empty() ? "SEM noise" : "noise")] =
      exact_list({sem.noise.slope, sem.noise.intercept, sem.noise.least_variance});
  for (const SemDiscrepancy& part : sem.discrepancy)
    id[prefix + "model error"] +=
        fmt::format("{} {:g} ", hash_of(part.deviation.data()), part.correlation_px);
  if (sem.guided_deviation > 0) id[prefix + "model error"] += format_exact(sem.guided_deviation);
}

/// Everything that the states of the reconstruction depend on.
Identity identity_of(const ReconstructionOptions& o, const AfmData* afm, const SemData* sem,
                     const StoredModel* model, const std::vector<SemView>& views,
                     const std::vector<PreparedView>& of_views,
                     const CorrectionRequest* corrections, int rounds) {
  Identity id{{"semsurf", version()},
              {"program", program_hash()},
              {"instruction set", std::string(instruction_set())}};
  ReconstructionOptions steps = o;  // without options of the final steps, which follow the states
  steps.uncertainty = ReconstructionOptions{}.uncertainty;
  steps.probes = ReconstructionOptions{}.probes;
  steps.seed = ReconstructionOptions{}.seed;
  for (const auto& [key, value] : record_of(steps)) id[key.substr(key.find('.') + 1)] = value;
  if (afm) {
    const HeightField& f = afm->image;
    id["scan"] = hash_of(f.z_nm.data()) + hash_of(f.valid.data()) +
                 exact_list({f.pitch_x_nm, f.pitch_y_nm, f.origin_x_nm, f.origin_y_nm});
    id["tip"] =
        hash_of(afm->tip.z_nm.data()) + fmt::format(" {} {}", afm->tip.apex_x, afm->tip.apex_y);
    id["AFM noise"] = exact_list({afm->noise.alpha, afm->noise.innovation_nm2});
    id["upsampling"] = std::to_string(afm->upsample);
  }
  if (sem) {
    add_image("SEM image", *sem, *model, id);
    id["transform"] = map_text(sem->sem_to_afm);
    if (sem->film) {
      id["film"] = sem->film->material;
      for (const auto& numbers : sem->film->per_nm)
        for (const double number : numbers) id["film"] += " " + format_exact(number);
    }
    if (!sem->row_jitter.empty()) id["line jitter"] = hash_of(sem->row_jitter.data());
  }
  for (std::size_t k = 0; k < views.size(); ++k) {
    const std::string of = fmt::format("view {}", k + 2);
    const SemView& view = views[k];
    add_image(of, view.sem, of_views[k].model, id);
    id[of + "'s pose"] = exact_list({view.pose.tilt_deg, view.pose.azimuth_deg, view.tilt_error_deg,
                                     view.scale_error, view.same_scan ? 1.0 : 0.0}) +
                         map_text(view.pose.to_plane);
  }
  if (corrections)
    id["corrections"] =
        fmt::format("{} {} {} {} {}", rounds, corrections->electrons, corrections->material.name,
                    mc::format_physics(corrections->physics), corrections->seed);
  return id;
}

mc::Material film_material(const ReconstructJob& job) {
  io::MaterialLibrary materials;
  std::vector<std::string> notes;
  for (const std::string& file : job.material_files) materials.read(file, notes);
  return materials.find(job.film, "`reconstruction.film`");
}

void check(const ReconstructJob& job) {
  if (!job.afm && !job.sem)
    throw UsageError("reconstruct", "neither a scan nor an SEM image is given",
                     "Add `reconstruction.afm=scan.gwy`, `reconstruction.sem=image.tif`, or both");
  check_results(job.folder, job.picture);
  if (!job.afm && !job.calibration)
    throw UsageError(
        "`reconstruction.gains`", "without a scan there is nothing to calibrate with",
        "Say `reconstruction.gains` and `reconstruction.offset`, or give `reconstruction.afm`");
  if (!job.film.empty() && !job.calibration)
    throw UsageError("`reconstruction.film`",
                     "a film changes an SEM image nearly as another gain does, so that its "
                     "thickness is known only where gains and offset are",
                     "Say `reconstruction.gains` and `reconstruction.offset`, or leave the film "
                     "to the gains, which cost no accuracy");
  if (!job.film.empty()) film_material(job);
  check_views(job);
  check_parameters(parameters_of(job));
  if (job.sem) validate(job.sem->image, "SEM image");
}

std::string seen(const ResidualReport& r) {
  return fmt::format(
      "mean {:.2f}, standard deviation {:.2f}, correlation of neighbours {:.2f} along and {:.2f} "
      "across rows",
      r.mean, r.deviation, r.along, r.across);
}

/// The limits are wider than chance alone: smaller errors change heights by less than their
/// standard deviations. What chance makes of few pixels comes on top.
bool like_noise(const ResidualReport& r) {
  constexpr double standard_errors = 2.5;
  const double n = std::max(1.0, static_cast<double>(r.pixels)),
               of_correlation = standard_errors / std::sqrt(n),
               of_deviation = of_correlation / std::sqrt(2);
  return r.like_noise && r.deviation >= least_deviation - of_deviation &&
         r.deviation <= largest_deviation + of_deviation &&
         std::max(std::abs(r.along), std::abs(r.across)) <= largest_correlation + of_correlation;
}

/// Reasons against trusting the result.
std::vector<std::string> reasons_of(const ReconstructSummary& s, double tilt_error_deg) {
  std::vector<std::string> reasons;
  const Reconstruction& r = s.result;
  if (!r.converged || (!r.scales.empty() && r.scales.back().ended == "iterations"))
    reasons.push_back(
        "the optimiser had not settled at the last scale: allow it more "
        "`reconstruction.iterations`");
  if (!r.scales.empty()) {
    const ScaleReport& last = r.scales.back();
    if (last.afm_residual.pixels > 0 && !like_noise(last.afm_residual))
      reasons.push_back(fmt::format(
          "the residual of the AFM scan does not look like noise ({}): check the tip and the "
          "scan's noise",
          seen(last.afm_residual)));
    if (last.sem_residual.pixels > 0 && !like_noise(last.sem_residual))
      reasons.push_back(fmt::format(
          "the residual of the SEM image does not look like noise ({}): check the registration, "
          "the model and the calibration",
          seen(last.sem_residual)));
  }
  for (std::size_t k = 0; k < r.views.size(); ++k) {
    const ViewResult& view = r.views[k];
    constexpr double far_off = 2.5;  // standard errors of the tilt that was said
    if (std::abs(view.pose.tilt_deg - s.views[k].tilt_deg) > far_off * tilt_error_deg)
      reasons.push_back(fmt::format(
          "view {} seems tilted by {:.2f} degrees, not {:g}: check `beam.tilt` and `beam.azimuth`",
          k + 2, view.pose.tilt_deg, s.views[k].tilt_deg));
    if (!like_noise(view.statistics))
      reasons.push_back(fmt::format(
          "the residual of view {} does not look like noise ({}): check its tilt and azimuth, and "
          "that it is of the same place",
          k + 2, seen(view.statistics)));
  }
  if (r.film_nm >= largest_film_nm)
    reasons.push_back(
        fmt::format("the film would be thicker than the {} that are sought: check its material, "
                    "`reconstruction.gains` and `reconstruction.offset`",
                    format_length(largest_film_nm)));
  if (s.afm && !s.afm->tip.doubt.empty())
    reasons.push_back(fmt::format("the AFM tip is not to be trusted: {}", s.afm->tip.doubt));
  if (s.rival)
    reasons.push_back(fmt::format(
        "another surface explains both images, with a probability of {:.2g}; it differs in {:.0f} "
        "% "
        "of its heights: see rival.vti, and say by landmarks or `registration.transform` which "
        "place is meant",
        s.rival->probability, 100 * s.rival->share_apart));
  if (s.afm && s.afm->tip_bound && !r.tip.z_nm.empty()) {
    constexpr double far_beyond = 10;
    const double thresholds = beyond({*s.afm->tip_bound, s.afm->tip_threshold_nm}, r.tip);
    if (thresholds > far_beyond)
      reasons.push_back(fmt::format(
          "the fitted tip is duller than what the scan itself allows, by {:.0f} times the noise's "
          "threshold: give the tip if you know it, or look for a double tip",
          thresholds));
  }
  if (s.pose && !s.pose->verified())
    reasons.push_back(fmt::format(
        "the registration is {} ({}): the SEM image may be displaced by {:.2g} pixels, which the "
        "deviations contain",
        name(s.pose->registration->verdict), s.pose->registration->reason,
        largest_px(s.place_doubt)));
  return reasons;
}

void keep_registration(const ReconstructJob& job, const PlacedImage& image, ReconstructSummary& s) {
  if (job.folder.empty()) return;
  io::TransformFile file;
  file.sem_to_afm = s.pose->sem_to_afm;
  file.verified = s.pose->verified();
  if (s.pose->registration)
    file.verdict =
        fmt::format("{}: {}", name(s.pose->registration->verdict), s.pose->registration->reason);
  file.notes = step_record("reconstruct", record_of(job), {job.afm->file, job.sem->file});
  s.written.push_back(job.folder / "transform.json");
  io::write_transform(s.written.back(), file);
  if (!job.picture) return;
  s.written.push_back(job.folder / "registration.png");
  io::Plot picture = registration_picture(image, s.pose->simulated, s.pose->sem_to_afm);
  picture.metadata = file.notes;
  io::write_plot(s.written.back(), picture);
}

/// Whether a blind tip is replaced by one that is found with the SEM image.
bool finds_tip(const ReconstructJob& job) {
  return job.afm && job.sem && !job.afm->preparation.tip && job.afm->preparation.tip_size == 0 &&
         job.refine_tip.value_or(true);
}

/// The physics that are asked for, or the model's own.
mc::Physics physics_of(const ReconstructJob& job, const StoredModel& model) {
  mc::Physics physics = job.model.physics;
  const auto own = model.trained.record.notes.find("physics");
  const bool asked = mc::format_physics(physics) != mc::format_physics({});
  if (asked || own == model.trained.record.notes.end()) return physics;
  mc::parse_physics(own->second, physics);
  return physics;
}

/// What Monte Carlo needs to correct the model; nothing without an SEM image, or for a model of
/// what cannot be simulated.
std::optional<CorrectionRequest> correction_request(const ReconstructJob& job,
                                                    const ReconstructSummary& s) {
  if (!job.sem || !s.model) return std::nullopt;
  CorrectionRequest request;
  request.material = job.model.material;
  if (request.material.name.empty()) {
    try {
      request.material = io::find_material(s.model->trained.scope.material, "model");
    } catch (const Error&) {  // a material of the user's own, whose file is not given
      return std::nullopt;
    }
  }
  if (!can_be_corrected(*s.model, request.material)) return std::nullopt;
  request.physics = physics_of(job, *s.model);
  request.electrons = job.correction_electrons;
  request.seed = job.options.seed;
  request.cache = job.model.folder.parent_path();
  request.threads = job.options.threads;
  return request;
}

/// What the film that is asked for changes in the yields.
FilmEffect film_of(const ReconstructJob& job, const ReconstructSummary& s, const Reporter& told) {
  const std::optional<CorrectionRequest> known = correction_request(job, s);
  const std::vector<mc::Detector> usual = mc::default_detectors();
  if (!known || std::ranges::any_of(s.model->model->channels(), [&](const std::string& name) {
        return std::ranges::find(usual, name, &mc::Detector::name) == usual.end();
      }))
    throw UsageError("`reconstruction.film`",
                     "what a film changes is known for models of SE and BSE of a known material "
                     "and energy only",
                     "Leave it out, or give a model that `semsurf train` made");
  begin(told, "film");
  FilmRequest request;
  request.film = film_material(job);
  request.specimen = known->material;
  request.energy_ev = s.model->trained.scope.energy_ev;
  request.physics = known->physics;
  request.seed = job.options.seed;
  request.threads = job.options.threads;
  return film_effect(request, s.model->model->channels(), told.watch());
}

/// Why the SEM image is not of the detector that was told.
std::string doubt_of_detector(const ReconstructSummary& s, const PlacedImage& image, int threads) {
  ModelOptions options;
  options.threads = threads;
  const SurfaceUnderSem under = surface_under_sem(s.afm->eroded(), image, s.pose->sem_to_afm);
  PlacedImage view = image;
  view.valid = under.known;
  return facing_doubt(s.model->model->channels().front(), [&](int quarters) {
    view.values = seen_from(*s.model->model, under.surface, quarters, options).front();
    return correlation_at(image, view, {});
  });
}

/// Collects the warnings of the chain's steps for a job.
class Warnings {
 public:
  Warnings(const Reporter& reporter, ReconstructSummary& summary) : told_(reporter) {
    told_.on_warning = [&reporter, &summary](const std::string& warning) {
      summary.warnings.push_back(warning);
      reporter.warn(warning);
    };
  }
  const Reporter& reporter() const { return told_; }

 private:
  Reporter told_;
};

}  // namespace

ReconstructionOptions options_of(const ReconstructJob& job, const ReconstructSummary& s) {
  ReconstructionOptions o = job.options;
  o.place_doubt = s.place_doubt;
  o.rough_ground = s.afm && s.afm->rough_ground;
  // It would follow the direction in which the channels, or a film, cannot be told apart.
  if (s.gains_tied || !job.film.empty()) o.refine_calibration = false;
  // A larger gain and lower hills explain an image as well.
  if (!job.afm) o.refine_calibration = false;
  o.refine_tip = job.afm && job.sem && o.method == ReconstructionMethod::gauss_newton &&
                 job.refine_tip.value_or(s.afm && !s.afm->tip_given);
  return o;
}

ReconstructSummary run(const ReconstructJob& job, const Reporter& reporter) {
  check(job);
  ReconstructSummary s;
  const Warnings warnings(reporter, s);
  const Reporter& told = warnings.reporter();
  const int threads = job.options.threads;
  PlacedImage image;
  if (job.sem) {
    image = job.sem->image;
    s.saturated = leave_out_saturated(image);
    if (s.saturated > 0)
      told.note(fmt::format("SEM: {} saturated pixels are left out", s.saturated));
    ModelRequest request = job.model;
    request.signal = first_signal(job);
    if (request.folder.empty()) request.folder = job.folder;  // no cache folder
    s.model = model_of(request, image, told);
  }
  if (job.afm) s.afm = prepare(*job.afm, threads, told, !finds_tip(job));
  if (job.afm && job.sem) {
    // An error of a pixel is small enough as an initial guess: the map is fitted with the surface.
    PoseOptions pose = job.pose;
    pose.registration.largest_stderr_px = std::max(pose.registration.largest_stderr_px, 1.0);
    s.pose = pose_of(pose, *s.afm, image, *s.model, threads, told);
    if (finds_tip(job) && !find_tip_with_sem(*s.afm, *s.pose, pose, image, *s.model, threads, told))
      warn_of_tip(*s.afm, told);
    if (s.pose->registration && s.pose->registration->verdict == RegistrationVerdict::unrelated &&
        !job.pose.accept_unverified) {
      keep_registration(job, image, s);
      s.verdict = ReconstructionVerdict::not_registered;
      s.reasons = {fmt::format("the registration is {}: {}", name(s.pose->registration->verdict),
                               s.pose->registration->reason)};
      return s;
    }
  }
  if (job.afm && job.sem && s.model->sided && !job.pose.accept_unverified)
    if (std::string doubt = doubt_of_detector(s, image, threads); !doubt.empty()) {
      keep_registration(job, image, s);
      s.verdict = ReconstructionVerdict::not_registered;
      s.reasons = {"SEM image: " + doubt};
      return s;
    }
  std::optional<AfmData> afm;
  std::optional<SemData> sem;
  if (job.afm)
    afm = AfmData{s.afm->image, s.afm->tip, s.afm->noise, job.upsample, s.afm->level_doubt};
  if (afm && job.sem) judge_places(job, s, image, *afm, told);
  if (s.pose && job.sem) s.place_doubt = place_doubt(*s.pose, job.sem->image);
  if (job.sem) sem = prepare_sem(job, s, image, afm ? &*afm : nullptr, told);
  if (sem && !job.film.empty()) sem->film = film_of(job, s, told);
  std::vector<SemView> views;
  if (!job.views.empty()) {
    std::optional<Reconstruction> coarse;
    if (afm && !all_known(job.known_views))
      coarse = reconstruct(&*afm, &*sem, coarse_options(job, s, s.gains_tied));
    views = prepare_views(job, s, *sem, coarse ? &coarse->surface : nullptr, told);
    for (std::size_t k = 0; k < s.views.size(); ++k)
      if (!s.views[k].doubt.empty() && !job.pose.accept_unverified)
        s.reasons.push_back(fmt::format("view {}: {}", k + 2, s.views[k].doubt));
    if (!s.reasons.empty()) {
      s.verdict = ReconstructionVerdict::not_registered;
      return s;
    }
  }

  begin(told, "reconstruction");
  const AfmData* afm_data = afm ? &*afm : nullptr;
  SemData* sem_data = sem ? &*sem : nullptr;
  const std::optional<CorrectionRequest> corrections =
      job.corrections > 0 ? correction_request(job, s) : std::nullopt;
  std::optional<ReconstructionCheckpoint> checkpoint;
  if (!job.folder.empty()) {
    std::filesystem::create_directories(job.folder);
    checkpoint.emplace(
        job.folder / "checkpoint",
        identity_of(options_of(job, s), afm_data, sem_data, s.model ? &*s.model : nullptr, views,
                    s.views, corrections ? &*corrections : nullptr, job.corrections),
        told.on_note);
    if (const auto state = checkpoint->found()) {
      s.resumed = true;
      told.note(
          fmt::format("{} scales are done already: going on from there", state->scales.size()));
    }
  }
  ReconstructionOptions options = options_of(job, s);
  options.watch = told.watch();
  ReconstructionCheckpoint* journal = checkpoint ? &*checkpoint : nullptr;
  if (corrections)
    s.result = correct_and_reconstruct(afm_data, *sem_data, views, options, s, *corrections,
                                       job.corrections, journal, told, s.corrections);
  else s.result = reconstruct(afm_data, sem_data, views, options, journal);
  if (afm && sem) s.rival = rival_surface(job, s, *afm, *sem, told);
  s.held = what_held(s.result);
  if (job.truth) s.truth = compare_with_truth(s.result, *job.truth);
  s.reasons = reasons_of(s, job.view_settings.tilt_error_deg);
  if (!s.reasons.empty()) s.verdict = ReconstructionVerdict::flagged;
  if (!checkpoint) return s;
  begin(told, "writing");
  s.written = write_reconstruction(job, s, afm_data, sem_data, views);
  checkpoint->remove();
  return s;
}

const char* name(ReconstructionVerdict verdict) {
  switch (verdict) {
    case ReconstructionVerdict::sound:
      return "sound";
    case ReconstructionVerdict::flagged:
      return "flagged";
    case ReconstructionVerdict::not_registered:
      break;
  }
  return "not registered";
}

const char* name(ReconstructionMethod method) {
  switch (method) {
    case ReconstructionMethod::gauss_newton:
      return "gauss-newton";
    case ReconstructionMethod::conjugate_gradients:
      return "conjugate-gradients";
    case ReconstructionMethod::lbfgs:
      break;
  }
  return "lbfgs";
}

}  // namespace surf::workflow
