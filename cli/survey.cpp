// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <optional>
#include <vector>

#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "failure.h"
#include "job_reporter.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/workflow/survey_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* survey_examples =
    R"(Columns: file, width, height, pitch_x_nm, pitch_y_nm, tilt_deg (taken off), substrate_share (of samples on the plane),
roughness_nm (Sq of those), relief_nm (from the 0.5th to the 99.5th percentile), noise_nm, tip_radius_nm (an
outer bound), tip_radius_error_nm (how far noise moves it), tip_half_angle_deg, broadening_nm (what the tip
adds on each side at half of the relief), problem.
The table is written anew after each scan: what is done is kept when you stop it.

Examples:
  semsurf survey scans/ -o table.csv
  semsurf survey *.spm --height-channel Height --tip-size 41 -o table.csv
  semsurf survey scans/ --no-tip                 roughness and noise alone, on the screen)";

struct SurveyArguments {
  BoundParameters bound;
  std::vector<std::string> scans;
  std::optional<std::string> output;
  bool quiet = false;
};

int survey_work(const SurveyArguments& o) {
  if (o.scans.empty())
    throw UsageError("survey", "no scan is given", "Give scans, or folders of scans");
  if (o.output) io::check_writable(*o.output);
  workflow::SurveyParameters parameters;
  workflow::LevelParameters levelling;
  workflow::TipParameters tip;
  io::HeightReadOptions reading;
  o.bound.apply(parameters), o.bound.apply(levelling), o.bound.apply(tip), o.bound.apply(reading);
  const auto files = workflow::scans_of({o.scans.begin(), o.scans.end()});
  std::vector<workflow::SurveyedScan> table;
  int code = 0;
  const JobReporter reporter(o.quiet);
  workflow::Reporter listener =
      reporter;  // what it would say is in the table, with the scan's name
  listener.on_note = listener.on_warning = nullptr;
  for (const std::filesystem::path& file : files) {
    try {
      const HeightField scan = read_scan(file.string(), reading, true).field;
      table.push_back(workflow::survey_scan(scan, parameters, levelling, tip, listener));
      table.back().file = file;
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      const int failed = report_failure();
      if (code == 0) code = failed;
      continue;
    }
    if (o.output) io::write_text(*o.output, workflow::survey_csv(table));
    if (o.quiet) continue;
    const workflow::SurveyedScan& s = table.back();
    const auto length = [](const std::optional<double>& nm) {
      return nm ? format_length(*nm) : std::string("unknown");
    };
    print("{}: roughness {}, noise {}", file.string(), format_length(s.roughness_nm),
          length(s.noise_nm));
    if (!parameters.no_tip)
      print(", tip {}{}, broadening {}", length(s.tip_radius_nm),
            s.tip_radius_error_nm ? " ± " + length(s.tip_radius_error_nm) : "",
            length(s.broadening_nm));
    print("\n");
    if (!s.problem.empty()) print_note(file.string() + ": " + s.problem);
    flush();
  }
  if (o.output && !table.empty() && !o.quiet) print_written({*o.output});
  return code;
}

}  // namespace

void add_survey(CLI::App& app, Action& action) {
  const auto o = std::make_shared<SurveyArguments>();
  CLI::App* sub = app.add_subcommand(
      "survey", "Roughness, noise, tip and its broadening of many AFM scans, as a table");
  with_role(sub->add_option("SCAN", o->scans, "AFM scans, or folders of scans")->type_name("FILE"),
            FileRole::read);
  o->bound.add<io::HeightReadOptions>(*sub, "Options");
  with_role(sub->add_option("-o,--output", o->output, "Table to write: CSV")->type_name("FILE"),
            FileRole::written);
  o->bound.add<workflow::SurveyParameters>(*sub, "Options");
  o->bound.looks["level.method"] = {.name = "--level-method"};
  o->bound.looks["level.degree"] = {.name = "--level-degree"};
  o->bound.looks["level.tolerance"] = {.name = "--level-tolerance"};
  o->bound.add<workflow::LevelParameters>(*sub, "Levelling");
  o->bound.looks["tip.size"] = {.name = "--tip-size"};
  o->bound.add<workflow::TipParameters>(*sub, "Tip", {}, {"tip.size", "tip.seed"});
  add_quiet_flag(*sub, o->quiet);
  sub->footer(survey_examples);
  sub->callback([o, &action] { action = [o] { return survey_work(*o); }; });
}

}  // namespace surf::cli
