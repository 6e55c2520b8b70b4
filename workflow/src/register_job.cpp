// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/register_job.h"

#include <fmt/format.h>

#include <cmath>

#include "chain_steps.h"
#include "registration_picture.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/plot.h"
#include "surf/io/transform_file.h"
#include "surf/workflow/step_record.h"
#include "tip_with_sem.h"

namespace surf::workflow {
namespace {

std::string hash_line(const std::filesystem::path& file) {
  return fmt::format("{} sha256 {}", file.filename().string(), io::sha256_of_file(file));
}

/// The job without the images.
RegisterJob parameters_of(const RegisterJob& job) {
  RegisterJob out;
  out.afm.reading = job.afm.reading;
  out.afm.preparation = job.afm.preparation;
  out.sem.reading = job.sem.reading;
  out.model = job.model;
  out.pose = job.pose;
  return out;
}

io::TransformFile transform_file(const RegisterJob& job, const RegisterSummary& s) {
  io::TransformFile file;
  file.sem_to_afm = s.pose.sem_to_afm;
  file.verified = s.pose.verified();
  file.notes = step_record("register", record_of(parameters_of(job)));
  file.notes.merge(std::map<std::string, std::string>{
      {"afm", hash_line(job.afm.file)},
      {"sem", hash_line(job.sem.file)},
      {"model", fmt::format("{} sha256 {}", s.model.file.filename().string(), s.model.sha256)}});
  if (!s.pose.registration) return file;
  const Registration& r = *s.pose.registration;
  file.verdict = fmt::format("{}: {}", name(r.verdict), r.reason);
  file.notes["score"] = format_exact(r.score);
  file.notes["stderr_px"] = format_exact(r.stderr_px);
  file.notes["overlap"] = format_exact(r.overlap);
  return file;
}

}  // namespace

RegisterSummary run(const RegisterJob& job, const Reporter& reporter) {
  check_parameters(parameters_of(job));
  validate(job.sem.image, "SEM image");
  if (!job.transform.empty()) io::check_writable(job.transform);
  if (!job.picture.empty()) io::check_plot_target(job.picture);
  RegisterSummary s;
  s.model = model_of(job.model, job.sem.image, reporter);
  const bool blind = !job.afm.preparation.tip && job.afm.preparation.tip_size == 0;
  s.afm = prepare(job.afm, job.threads, reporter, !blind);
  s.pose = pose_of(job.pose, s.afm, job.sem.image, s.model, job.threads, reporter);
  const bool related =
      s.pose.registration && s.pose.registration->verdict != RegistrationVerdict::unrelated;
  if (blind && !(related && find_tip_with_sem(s.afm, s.pose, job.pose, job.sem.image, s.model,
                                              job.threads, reporter)))
    warn_of_tip(s.afm, reporter);
  if (!job.transform.empty()) io::write_transform(job.transform, transform_file(job, s));
  if (!job.picture.empty()) {
    io::Plot picture = registration_picture(job.sem.image, s.pose.simulated, s.pose.sem_to_afm);
    picture.metadata = transform_file(job, s).notes;
    io::write_plot(job.picture, picture);
  }
  return s;
}

}  // namespace surf::workflow
