// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/simulate_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>

#include "checkpoint.h"
#include "disk_needs.h"
#include "extras.h"
#include "guided/guide_model.h"
#include "guided/guided_images.h"
#include "guided/guided_simulation.h"
#include "guided/scene_guides.h"
#include "job_libraries.h"
#include "provenance.h"
#include "sidecar.h"
#include "simulation_setup.h"
#include "specimen_facts.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/volume_file.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/sampling/choose_method.h"
#include "surf/workflow/tier_doubt.h"
#include "surf/workflow/trajectories.h"
#include "team_libraries.h"
#include "team_scheduler.h"
#include "time_budget.h"
#include "warnings.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

// For large images only: notes where the results of all pixels are stored until they are written.
void tell_of_scratch(const ResolvedJob& job, const mc::Scan& scan, const NoteCallback& note) {
  const std::size_t bytes = mc::tally_bytes(scan, job.options);
  if (note && bytes > job.options.tally_memory)
    note(fmt::format(
        "{} x {} pixels: {:.3g} GB of intermediate results go to a scratch file in {}, "
        "not into memory",
        scan.width, scan.height, static_cast<double>(bytes) / 1e9, job.options.scratch_folder));
}

// Makes the job's checkpoint, if the job can have one.
std::unique_ptr<Checkpoint> make_checkpoint(const ResolvedJob& job,
                                            const std::map<std::string, std::string>& settings,
                                            const NoteCallback& note, const NoteCallback& warn) {
  if (!job.checkpoint.wanted || job.extras.deposit_cells > 0 || job.outputs.empty()) return nullptr;
  const auto say = [](const std::string&) {};
  return std::make_unique<Checkpoint>(job.checkpoint, job.outputs.front(),
                                      identity_of(job, settings), note ? note : say,
                                      warn ? warn : say);
}

// Formats 0.013 as "1.3%", the form of the parameter.
std::string option_text(double accuracy) {
  std::string text = format_share(accuracy);
  std::erase(text, ' ');
  return text;
}

struct Simulation {
  mc::SimulationResult result;
  bool final = false;  ///< the result is the requested one, not a preliminary one
};

double seconds_since(std::chrono::system_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::system_clock::now() - start).count();
}

// For a time budget: simulates coarsely and sets the accuracy that fits. The result is final if no
// better accuracy fits, or if it was cancelled.
Simulation find_accuracy(ResolvedJob& job, const mc::Scene& scene, const JobLibraries& kept,
                         const mc::MethodChoice& choice, const RunRecord& record,
                         const mc::SimulationContext& context, const Simulator& simulator,
                         const NoteCallback& note, Team* team) {
  Simulation coarse;
  coarse.result = simulator(scene, job.options, context);
  if (!leads(team)) return coarse;  // a follower has no counts
  const auto say = [&](const std::string& text) {
    if (note) note(text);
  };
  coarse.final = !coarse.result.complete;
  if (coarse.final) return coarse;
  const double spent = seconds_since(record.start);
  TimeBudget budget;
  budget.seconds_left = job.seconds() - spent;
  budget.materials = scene.materials().size();
  budget.most_library_cascades = mc::MethodLimits{}.library_bytes /
                                 (choice.library_bytes / static_cast<double>(choice.cascades));
  const auto pages = kept.pages();
  budget.cascades_made =
      (pages.made > 0 ? pages.made : pages.loaded) * mc::CascadeLibrary::page_cascades;
  job.options.budget =
      mc::Accuracy{accuracy_that_fits(coarse.result, budget), mc::floor_of(job.scene.budget)};
  const double accuracy = mc::accuracy_of(job.options.budget);
  if (accuracy < coarse_accuracy) {
    say(fmt::format("{} accuracy fits in {:g} s; `simulation.accuracy={}` repeats this exactly",
                    format_share(accuracy), job.seconds(), option_text(accuracy)));
    return coarse;
  }
  const std::string again =
      fmt::format("`simulation.accuracy={}` repeats this exactly", option_text(coarse_accuracy));
  if (spent > job.seconds())
    say(fmt::format("{:g} s are too short: even {} accuracy took {:.2g} s; {}", job.seconds(),
                    format_share(coarse_accuracy), spent, again));
  else
    say(fmt::format("no better than {} accuracy fits in {:g} s; {}", format_share(coarse_accuracy),
                    job.seconds(), again));
  coarse.final = true;
  return coarse;
}

// Does the same on all members of a team. The leader has seen the counts and decides.
Simulation simulate_coarsely(ResolvedJob& job, const mc::Scene& scene, const JobLibraries& kept,
                             const mc::MethodChoice& choice, const RunRecord& record,
                             const mc::SimulationContext& context, const Simulator& simulator,
                             const NoteCallback& note, Team* team) {
  Simulation coarse;
  std::exception_ptr thrown;
  try {
    coarse = find_accuracy(job, scene, kept, choice, record, context, simulator, note, team);
  } catch (...) {
    if (!team) throw;
    thrown = std::current_exception();
  }
  if (!team) return coarse;
  // The leader must always broadcast, even after a failure, which 2 stands for.
  std::string found = fmt::format("{} {}",
                                  thrown         ? 2
                                  : coarse.final ? 1
                                                 : 0,
                                  format_exact(mc::accuracy_of(job.options.budget)));
  team->broadcast(found);
  if (thrown && leads(team)) std::rethrow_exception(thrown);
  if (found[0] == '2') throw Interrupted();  // the leader reports the reason
  coarse.final = found[0] == '1';
  job.options.budget = mc::Accuracy{std::stod(found.substr(2)), mc::floor_of(job.scene.budget)};
  return coarse;
}

// Keeps the checkpoint of a job that was cancelled or could not write its files.
void keep_interrupted(const ResolvedJob& job, Checkpoint* checkpoint, const NoteCallback& note) {
  if (checkpoint && checkpoint->keep()) {
    if (note)
      note(fmt::format(
          "what is done is kept in {}; the same command{} goes on from there",
          checkpoint->path().string(),
          job.seconds() > 0
              ? fmt::format(" with `simulation.accuracy={}` in place of `simulation.time`",
                            option_text(mc::accuracy_of(job.options.budget)))
              : ""));
  } else if (note && job.extras.deposit_cells > 0) {
    note("deposited energy is not kept on the way: the same command begins anew");
  }
}

ImageRows rows_of(const SimulateSummary& summary) {
  ImageRows image = mc::make_image_rows(summary.result, summary.scan);
  if (!summary.guided.empty()) show_guided(summary.result, summary.guided, image);
  return image;
}

ImageRows labelled_image(const ResolvedJob& job, const mc::Scene& scene,
                         const SimulateSummary& summary) {
  ImageRows image = rows_of(summary);
  add_channels(scene, job, summary.result, summary.guided, image);
  for (const auto& [key, value] : summary.record) image.head.metadata[key] = value;
  return image;
}

void write_all(const ResolvedJob& job, const ImageRows& image, SimulateSummary& summary,
               RunRecord record) {
  for (const fs::path& output : job.outputs) {
    io::write_image(output, image, {job.png_channel, job.layout, label_channels()});
    summary.written.push_back(output);
  }
  record.end = std::chrono::system_clock::now();
  record.outputs = job.outputs;
  for (const fs::path& extra : extra_files(job)) record.outputs.push_back(extra);
  const std::string text = sidecar_text(job, summary, record);
  for (const fs::path& output : job.outputs) {
    const fs::path path = sidecar_path(output);
    if (std::find(summary.written.begin(), summary.written.end(), path) != summary.written.end())
      continue;
    io::write_text(path, text);
    summary.written.push_back(path);
  }
}

}  // namespace

Image image_of(const SimulateSummary& summary) { return to_image(rows_of(summary)); }

SimulateSummary run(SimulateJob asked, const Reporter& reporter, Team* team,
                    const Simulator& given) {
  const CancelToken* const cancel = reporter.cancel;
  const NoteCallback& tell = reporter.on_note;
  const NoteCallback& warn = reporter.on_warning;
  const Simulator simulator = given ? given : Simulator(mc::simulate);
  RunRecord record;
  record.start = std::chrono::system_clock::now();
  ResolvedJob job;
  SimulateSummary summary;
  SpecimenFacts facts;
  std::optional<mc::Scene> ready;
  double expected_primaries = 0;   // of a guided image
  double cascades_that_fit = 1e6;  // into memory; refined where libraries are of use
  const auto note = [&](std::vector<std::string> warnings) {
    for (std::string& warning : warnings) {
      if (warn) warn(warning);
      summary.warnings.push_back(std::move(warning));
    }
  };
  together(team, [&] {
    check_extras(asked.extras);
    if (team && asked.extras.deposit_cells > 0)
      throw UsageError("`output.deposit`", "each of several processes would see a part of it",
                       "Run it in one process");
    job = resolve(std::move(asked));
    check_extras_of(job);
    if (leads(team) && !job.outputs.empty()) {  // followers write nothing
      check_outputs(job);
      check_checkpoint(job);
    }
    if (leads(team)) record.inputs = hash_inputs(job.scene.inputs);
  });
  NodeMemory* const node = node_of(team);
  together(team, [&] {
    facts = facts_of(job.scene.specimen, node, {{}, cancel});
    summary.scan = resolve_scan(job.scene.scan, facts.extent, job.scene.beam);
    check_trajectories(job, summary.scan);
    settle_estimate(job.estimate, job.options, summary.scan);
    // The first process's meshes are traced.
    if (node && !node->is_first())
      for (mc::Body& body : job.scene.specimen.bodies) body.mesh = {};
    ready.emplace(make_scene(job, facts, node, tell, cancel, summary));
  });
  together(team, [&] {
    summary.scene = ready->summary();
    note(warn_before(job, facts, summary.scan));
    // About this machine at present, so not for the record.
    if (leads(team) && warn)
      for (const std::string& warning : warn_of_full_disks(disk_needs(job, summary.scan)))
        warn(warning);
    note(warnings_of(job.scene.specimen, summary.simplification));
    const mc::SimulationOptions expected =
        job.estimate.kind == Estimate::guided
            ? expected_options(*ready, job.options, cascades_that_fit)
            : job.options;
    summary.choice =
        mc::choose_method(*ready, expected, job.scene.method, {job.extras.deposit_cells > 0});
    job.options.method = summary.choice.method;
    if (job.seconds() == 0)  // else how many fit is not known yet
      expected_primaries = mc::mean_electrons_of(expected.budget) * summary.scan.width *
                           static_cast<double>(summary.scan.height);
  });
  const mc::Scene& scene = *ready;
  const io::SceneFile& s = job.scene;
  const bool guided = job.estimate.kind == Estimate::guided;
  GuideModel guide_model;
  SceneGuides guides;
  together(team, [&] {
    if (!guided || !leads(team)) return;
    guide_model = find_guide_model(job.estimate, scene, job.cache, expected_primaries,
                                   job.options.threads, reporter);
    guides = guides_of(scene, guide_model, job.options.threads, reporter.watch());
  });
  JobLibraries kept(job.cache, reporter.counting("cascades"), tell);
  std::optional<TeamLibraries> of_team;
  if (team) of_team.emplace(*team, kept);
  mc::LibrarySource& libraries = team ? static_cast<mc::LibrarySource&>(*of_team) : kept;
  Simulation simulation;
  const ProgressCallback progress = reporter.counting(
      mc::accuracy_of(job.options.budget) > 0 && !guided ? "pixels" : "primaries");
  std::optional<TeamScheduler> processes;
  if (team) processes.emplace(*team);
  mc::SimulationContext context{.watch = {progress, cancel},
                                .libraries = &libraries,
                                .scheduler = processes ? &*processes : nullptr};
  if (job.seconds() > 0 && guided) {
    const std::int64_t electrons =
        electrons_that_fit(scene, job.options, guides, cascades_that_fit, context, simulator,
                           job.seconds() - seconds_since(record.start), team);
    job.options.budget = mc::ElectronsPerPixel{electrons};
    if (tell && leads(team))
      tell(
          fmt::format("{} electrons per pixel fit in {:g} s; `simulation.electrons={}` repeats "
                      "this exactly",
                      electrons, job.seconds(), electrons));
  }
  if (job.seconds() > 0 && !guided)
    simulation =
        simulate_coarsely(job, scene, kept, summary.choice, record, context, simulator, tell, team);
  if (job.seconds() > 0 && !guided && !simulation.final) {  // as with a request for that accuracy
    summary.choice =
        mc::choose_method(scene, job.options, s.method, {job.extras.deposit_cells > 0});
    job.options.method = summary.choice.method;
  }
  auto settings = leads(team) ? provenance(job, summary.scan, record.inputs)
                              : std::map<std::string, std::string>();
  if (guided) settings["simulation.guided_by"] = guide_model.identity;

  std::optional<Deposits> deposits;
  if (job.extras.deposit_cells > 0) {
    deposits.emplace(scene, job.extras.deposit_cells, resolve_threads(job.options.threads));
    context.observers = [&](int thread) { return deposits->of_thread(thread); };
  }
  tell_of_scratch(job, summary.scan, tell);
  std::unique_ptr<Checkpoint> checkpoint;
  together(team, [&] {
    if (!simulation.final && leads(team)) checkpoint = make_checkpoint(job, settings, tell, warn);
  });
  context.watch.progress = [&](double done, double total) {
    if (checkpoint) checkpoint->expect(total);
    progress(done, total);
  };
  context.journal = checkpoint.get();
  if (guided) {
    GuidedSimulation done = simulate_guided(scene, job.options, guides, cascades_that_fit, context,
                                            simulator, reporter, team);
    simulation.result = std::move(done.result);
    summary.guided = std::move(done.images);
    summary.rounds = done.rounds;
  } else if (!simulation.final) {
    simulation.result = simulator(scene, job.options, context);
  }
  summary.result = std::move(simulation.result);
  if (!leads(team)) return summary;
  if (team) summary.team = team->members();
  summary.pages_loaded = kept.pages().loaded;
  summary.pages_made = kept.pages().made;
  summary.statistics = mc::summarize(summary.result);
  if (guided) {
    summarize_accuracy(summary.guided, job.options.budget, summary.statistics);
    summary.guided_by = guide_model.reason;
    summary.gains = gains_of(summary.result, summary.guided);
  }
  if (const double accuracy = mc::accuracy_of(job.options.budget); accuracy > 0)
    summary.tier = tier_doubt(scene.physics(), scene.materials().size(), accuracy);
  summary.charging = charging_of(scene.materials(), summary.result, scene.scan());
  // Before anything is written: a failure to write must not destroy the work.
  if (!summary.result.complete) keep_interrupted(job, checkpoint.get(), tell);
  note(warn_after(summary.result, summary.statistics));

  summary.record = settings;
  summary.record.merge(outcome(summary));
  summary.record.merge(output_settings(job));
  if (job.keep_image) summary.image = to_image(labelled_image(job, scene, summary));
  if (job.outputs.empty()) {
    if (job.extras.trajectories > 0)
      summary.tracks = record_trajectories(scene, job.options.seed, job.extras.trajectories,
                                           job.extras.trajectories_at_nm)
                           .tracks;
    return summary;
  }
  try {
    const ImageRows image = labelled_image(job, scene, summary);
    if (deposits) {
      Volume volume = deposits->density(summary.result.balance.incident);
      volume.metadata = image.head.metadata;
      io::write_volume(extra_path(job, ".deposit.vti"), volume);
    }
    if (job.options.spectra)
      io::write_text(extra_path(job, ".spectra.csv"), spectra_text(summary.result));
    if (job.extras.trajectories > 0) write_trajectories(scene, job, settings);
    for (const fs::path& extra : extra_files(job)) summary.written.push_back(extra);
    write_all(job, image, summary, std::move(record));
  } catch (const Error&) {
    // A full disk, for example, must not destroy the work as well.
    if (summary.result.complete) keep_interrupted(job, checkpoint.get(), tell);
    throw;
  }
  if (checkpoint && summary.result.complete) checkpoint->finish();
  return summary;
}

}  // namespace surf::workflow
