// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/chain_chart_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "../chain_steps.h"
#include "../compare_truth.h"
#include "../job_identity.h"
#include "../sem_frame.h"
#include "chain_chart_files.h"
#include "chain_chart_plot.h"
#include "chain_methods.h"
#include "kept_point.h"
#include "peak_memory.h"
#include "surf/afm/morphology.h"
#include "surf/core/error.h"
#include "surf/core/instruction_set.h"
#include "surf/io/files.h"
#include "surf/io/plot.h"
#include "surf/io/sim/materials.h"
#include "surf/workflow/reconstruct_job.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr int usual_draws = 10, quick_draws = 3;
constexpr double prepared_weight = 1;  // weight of the preparation in the progress; a point has 1

ChainChartJob complete(const ChainChartJob& asked) {
  check_parameters(asked);
  ChainChartJob job = asked;
  if (job.draws == 0) job.draws = job.quick ? quick_draws : usual_draws;
  const auto& all = chain_chart_families();
  for (const std::string& family : job.families)
    if (std::none_of(all.begin(), all.end(),
                     [&](const ChainFamily& f) { return f.name == family; })) {
      std::string names;
      for (const ChainFamily& f : all) names += (names.empty() ? "" : ", ") + f.name;
      throw UsageError("`chart.methods`", fmt::format("'{}' is none of those for samples", family),
                       "Choose of " + names);
    }
  if (job.folder.empty()) throw UsageError("`output`", "no folder is given", "Add `output=chart`");
  std::error_code ignored;
  if (fs::equivalent(job.folder, job.sample, ignored))
    throw UsageError("`output`", "it is the sample's own folder",
                     "Name another one, as `output=chart`");
  return job;
}

// Identifies everything that the results depend on, so that points of another job do not count.
std::string identity_of(const ChainSetting& setting) {
  const ChainChartJob& job = setting.job;
  Identity id{{"semsurf", version()},
              {"program", program_hash()},
              {"instruction set", std::string(instruction_set())},
              {"model", setting.model.sha256},
              {"seed", std::to_string(job.seed)},
              {"draws", std::to_string(job.draws)},
              {"quick", job.quick ? "yes" : "no"}};
  for (const char* name : {"afm.gsf", "sem.tif", "truth.gsf", "truth_tip.gsf", "truth.json"})
    id[name] = io::sha256_of_file(job.sample / name);
  return fingerprint(id).substr(0, 32);
}

StoredModel find_model(const ChainChartJob& job, const SampleTruth& sample,
                       const Reporter& reporter) {
  ModelRequest request;
  request.file = job.model;
  request.folder = job.models;
  request.material = io::find_material(sample.material, "sample");
  request.energy_ev = sample.energy_ev;
  request.spot_nm = sample.spot_nm;
  request.spot_given = true;
  request.threads = job.threads;
  return model_of(std::move(request), sample.sem.image, reporter);
}

class Runner {
 public:
  Runner(const ChainSetting& setting, const Reporter& reporter, double total,
         ChainChartSummary& summary)
      : setting_(setting), reporter_(reporter), identity_(identity_of(setting)), total_(total),
        summary_(summary) {}

  Watch watch() const {
    Watch watch;
    watch.cancel = reporter_.cancel;
    watch.progress = [this](double done, double total) {
      if (total > 0) reporter_.progress(done_ + std::min(1.0, done / total), total_);
    };
    return watch;
  }

  /// Returns false if cancelled. A method that is impossible with this sample is left out.
  template <class Point>
  bool run(const ChainMethod<Point>& method, const std::function<void(const Point&)>& tell,
           std::vector<Point>& points) {
    const fs::path file = file_of(method.point.id);
    if (const auto json = kept_point(file, identity_)) {
      Point point;
      try {
        from_json(*json, point);
        points.push_back(std::move(point));
        ++summary_.found;
        advance();
        return true;
      } catch (const nlohmann::json::exception&) {  // damaged: the point is made again
      } catch (const std::out_of_range&) {
      }
    }
    if (cancelled()) return false;
    Point point = method.point;
    try {
      const PeakMemory memory;
      method.run(setting_, watch(), point);
      if constexpr (requires { point.peak_bytes; }) point.peak_bytes = memory.bytes();
    } catch (const Interrupted&) {
      return false;
    } catch (const InvalidInput& e) {
      summary_.left_out.push_back(fmt::format("{}: {}", point.id, e.reason()));
      advance();
      return true;
    }
    keep_point(file, identity_, to_json(point));
    if (tell) tell(point);
    points.push_back(std::move(point));
    advance();
    return true;
  }

  bool find_floor() {
    const fs::path file = file_of("floor");
    if (const auto json = kept_point(file, identity_); json && json->is_number()) {
      summary_.floor_nm = *json;
    } else {
      if (cancelled()) return false;
      ReconstructionOptions options;
      options.threads = setting_.job.threads;
      options.watch = watch();
      const SampleTruth& s = setting_.sample;
      try {
        summary_.floor_nm = noise_floor_nm(&s.afm, &s.sem, s.truth, options);
      } catch (const Interrupted&) {
        return false;
      }
      keep_point(file, identity_, summary_.floor_nm);
    }
    advance();
    return true;
  }

  void advance() {
    done_ += 1;
    reporter_.progress(done_, total_);
  }

 private:
  bool cancelled() const { return reporter_.cancelled(); }
  fs::path file_of(const std::string& id) const {
    return setting_.job.folder / "points" / (id + ".json");
  }

  const ChainSetting& setting_;
  const Reporter& reporter_;
  std::string identity_;
  double done_ = prepared_weight, total_;
  ChainChartSummary& summary_;
};

void write(const ChainChartJob& job, ChainChartSummary& s) {
  const auto text = [&](const char* name, const std::string& what) {
    io::write_text(job.folder / name, what);
    s.written.push_back(job.folder / name);
  };
  const auto plot = [&](const std::string& name, io::Plot what) {
    what.metadata = step_record("chart", record_of(job));
    for (const char* extension : {".svg", ".png"}) {
      io::write_plot(job.folder / (name + extension), what);
      s.written.push_back(job.folder / (name + extension));
    }
  };
  text("chart.json", chain_json(job, s));
  if (!s.registrations.empty()) {
    text("registration.csv", registration_csv(s));
    plot("registration", registration_plot(s));
  }
  if (!s.reconstructions.empty()) {
    text("reconstruction.csv", reconstruction_csv(s));
    plot("reconstruction", reconstruction_plot(s));
  }
}

}  // namespace

const std::vector<ChainFamily>& chain_chart_families() {
  static const std::vector<ChainFamily> families{
      {"correlation", "registration from a start that is off, by normalised cross-correlation",
       true},
      {"mutual-information", "the same by mutual information", true},
      {"landmarks", "from four landmarks that are off, refined by correlation", true},
      {"landmarks-only", "the landmarks' own map", true},
      {"search", "registration without a start", true},
      {"erosion", "the scan with the tip taken off", false},
      {"afm", "reconstruction from the scan alone", false},
      {"sem", "reconstruction from the SEM image alone", false},
      {"gauss-newton", "from both, with the usual method", false},
      {"conjugate-gradients", "from both, with the thesis's method", false},
      {"lbfgs", "from both, with L-BFGS", false},
      {"chain", "as 'semsurf reconstruct' does it, tip, map and gains found; not in a quick chart",
       false}};
  return families;
}

bool wants(const ChainChartJob& job, const std::string& family) {
  return job.families.empty() ||
         std::find(job.families.begin(), job.families.end(), family) != job.families.end();
}

ChainChartSummary run(const ChainChartJob& asked, const Reporter& reporter,
                      const ChainChartCallbacks& on_point) {
  const ChainChartJob job = complete(asked);
  ChainChartSummary summary;
  const auto registrations = list_registrations(job);
  const auto reconstructions = list_reconstructions(job);
  if (registrations.empty() && reconstructions.empty())
    throw UsageError("`chart.methods`", "with `chart.quick` the chain is left out",
                     "Leave out `chart.quick`, or ask for others too");
  if (job.quick && wants(job, "chain"))
    summary.left_out.push_back("chain: in a quick chart it would take too long");
  SampleTruth sample = read_sample(job.sample);
  summary.sample = sample.name;
  io::check_writable(job.folder / "chart.json");
  if (!registrations.empty()) io::check_plot_target(job.folder / "registration.png");
  if (!reconstructions.empty()) io::check_plot_target(job.folder / "reconstruction.png");

  const double total = prepared_weight +
                       static_cast<double>(registrations.size() + reconstructions.size()) +
                       (reconstructions.empty() ? 0 : 1);
  Reporter training;
  training.on_note = reporter.on_note;
  training.on_warning = reporter.on_warning;
  training.cancel = reporter.cancel;
  training.on_progress = [&](double done, double all, std::string_view) {
    if (all > 0) reporter.progress(prepared_weight * std::min(1.0, done / all), total);
  };
  StoredModel model;
  try {
    model = find_model(job, sample, training);
  } catch (const Interrupted&) {
    summary.complete = false;
    return summary;
  }
  give_model(sample, model.model, job.threads);
  MorphologyOptions morphology;
  morphology.threads = job.threads;
  HeightField eroded = erode(sample.afm.image, sample.afm.tip, morphology);
  PlacedImage simulated =
      simulated_view(eroded, *model.model, sample.sem.image.pitch_x_nm, job.threads);
  SurfaceUnderSem under = surface_under_sem(eroded, sample.sem.image, sample.sem.sem_to_afm);
  under.surface.valid = under.known;
  summary.eroded_nm = rms_off(under.surface, sample.truth);
  const ChainSetting setting{job, std::move(sample), std::move(model), std::move(eroded),
                             std::move(simulated)};

  Runner runner(setting, reporter, total, summary);
  for (const auto& method : registrations)
    if (summary.complete)
      summary.complete = runner.run(method, on_point.registration, summary.registrations);
  if (!reconstructions.empty() && summary.complete) summary.complete = runner.find_floor();
  for (const auto& method : reconstructions)
    if (summary.complete)
      summary.complete = runner.run(method, on_point.reconstruction, summary.reconstructions);
  if (!summary.complete) return summary;
  for (const ChainFamily& family : chain_chart_families())
    if (std::ranges::any_of(summary.registrations,
                            [&](const RegistrationPoint& p) { return p.family == family.name; }))
      summary.ranges.push_back(capture_range(summary.registrations, family.name));
  write(job, summary);
  return summary;
}

}  // namespace surf::workflow
