// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/sweep_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "common_parameters.h"
#include "job_identity.h"
#include "provenance.h"
#include "run_many.h"
#include "sidecar.h"
#include "simulation_setup.h"
#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/core/units.h"
#include "surf/core/words.h"
#include "surf/io/files.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string hash_of(const std::string& text) {
  return io::sha256_of(std::as_bytes(std::span(text))).substr(0, 32);
}

// Identifies a sweep by its axes and all values.
std::string sweep_identity(const SweepJob& job) {
  std::string text = fmt::format("{}\n", fmt::join(job.axes, " "));
  for (const SweepRun& run : job.runs) text += fmt::format("{}\n", fmt::join(run.values, " "));
  return hash_of(text);
}

std::string run_identity(const SimulateJob& job) {
  const mc::Scan scan =
      resolve_scan(job.scene.scan, mc::extent(job.scene.specimen), job.scene.beam);
  const ResolvedJob resolved = resolve(job);
  Identity identity = identity_of(resolved, provenance(resolved, scan, {}));
  identity.merge(surf::record_of(static_cast<const mc::SimulationRequest&>(job.scene)));
  identity["simulation.method"] = job.scene.method ? mc::name(*job.scene.method) : "auto";
  for (const auto& output : job.outputs) identity["outputs"] += output.filename().string() + " ";
  for (const std::string& channel : job.extras.channels) identity["channels"] += channel + " ";
  return fingerprint(identity);
}

fs::path record_path(const fs::path& folder, std::size_t number) {
  return folder / "records" / fmt::format("{}.json", number + 1);
}

std::optional<Json> read_record(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  try {
    return Json::parse(io::read_file(path));
  } catch (const Json::exception&) {
    return std::nullopt;  // damaged: the run is done again
  }
}

// Throws if the folder holds another sweep, whose table, records and images would be replaced.
void refuse_another_sweep(const SweepJob& job, const std::string& sweep) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(job.folder / "records", ignored)) {
    const auto record = read_record(entry.path());
    if (!record || !record->contains("sweep") || (*record)["sweep"] == sweep) continue;
    std::string what;
    if (record->contains("axes") && record->contains("of"))
      what = fmt::format(": {} runs over {}", (*record)["of"].dump(),
                         fmt::join((*record)["axes"].get<std::vector<std::string>>(), ", "));
    throw InvalidInput(job.folder.string(), "it holds a sweep over another grid" + what,
                       "Name another folder with -o, or remove this folder first");
  }
}

bool is_done(const fs::path& folder, std::size_t number, const SweepRun& what,
             const std::string& sweep) {
  const auto record = read_record(record_path(folder, number));
  if (!record || record->value("sweep", "") != sweep) return false;
  const SimulateJob run = what.make();
  if (record->value("run", "") != run_identity(run)) return false;
  std::error_code ignored;
  return std::all_of(run.outputs.begin(), run.outputs.end(),
                     [&](const fs::path& output) { return fs::is_regular_file(output, ignored); });
}

std::string record_of(const SweepJob& job, std::size_t number, const SimulateJob& run,
                      const std::string& sweep, const SimulateSummary& s) {
  Json record{{"sweep", sweep},
              {"run", run_identity(run)},
              {"number", number + 1},
              {"of", job.runs.size()},
              {"axes", job.axes},
              {"values", job.runs[number].values},
              {"file", run.outputs.front().filename().string()},
              {"missed", s.statistics.missed}};
  for (std::size_t d = 0; d < s.result.detectors.size(); ++d)
    record["yields"].push_back({{"detector", s.result.detectors[d].name},
                                {"mean", s.statistics.yields[d].mean},
                                {"standard_error", s.statistics.yields[d].standard_error}});
  return record.dump(1) + "\n";
}

std::string quoted(const std::string& text) {
  return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

// The table of a sweep's records, by number.
std::string table_of(const std::map<std::size_t, Json>& records) {
  if (records.empty()) return "";
  const Json& first = records.begin()->second;
  std::string text = "run";
  for (const auto& axis : first["axes"]) text += fmt::format(",{}", axis.get<std::string>());
  text += ",file";
  for (const auto& yield : first["yields"]) {
    const std::string name = yield["detector"];
    text += fmt::format(",{0},{0}.stderr", name);
  }
  text += ",pixels_missed\n";
  for (const auto& [number, record] : records) {
    text += std::to_string(number);
    for (const auto& value : record["values"])
      text += fmt::format(",{}", quoted(value.get<std::string>()));
    text += fmt::format(",{}", quoted(record["file"].get<std::string>()));
    for (const auto& yield : record["yields"])
      text += fmt::format(",{:.9g},{:.4g}", yield["mean"].get<double>(),
                          yield["standard_error"].get<double>());
    text += fmt::format(",{}\n", record["missed"].get<std::int64_t>());
  }
  return text;
}

// The leader decides for a team: other members may see the folder's files later.
std::vector<std::size_t> find_missing(const SweepJob& job, const std::vector<std::size_t>& mine,
                                      const std::string& sweep, Team* team) {
  std::string letters(mine.size(), '-');
  together(team, [&] {
    if (!leads(team)) return;
    for (std::size_t k = 0; k < mine.size(); ++k)
      if (is_done(job.folder, mine[k], job.runs[mine[k]], sweep)) letters[k] = '+';
  });
  if (team) team->broadcast(letters);
  std::vector<std::size_t> missing;
  for (std::size_t k = 0; k < mine.size(); ++k)
    if (letters[k] == '-') missing.push_back(mine[k]);
  return missing;
}

// Takes the size of all runs from the first.
void describe(const SimulateJob& first, ManyRuns& runs) {
  const mc::Scan scan =
      resolve_scan(first.scene.scan, mc::extent(first.scene.specimen), first.scene.beam);
  runs.tiles = tiles_of(scan);
  runs.pixels = static_cast<double>(scan.width) * scan.height;
  runs.threads = first.execution.threads;
}

}  // namespace

void describe(ParameterVisitor& visit, SweepJob& job) {
  describe_folder(visit, job.folder, "Folder of the images and the table");
  visit.form(
      {.name = "sweep.part",
       .help = "Part of the sweep to do, part K of N: the third of 16 is 3/16",
       .otherwise = "all",
       .form = "K/N",
       .recorded = false},
      [&] { return job.parts > 1 ? fmt::format("{}/{}", job.part, job.parts) : std::string(); },
      [&](std::string_view text, const std::string& subject) {
        const auto words = split(text, "/");
        if (words.size() != 2)
          throw UsageError(subject, fmt::format("'{}' is no part", text),
                           "Write 3/16 for the third of 16");
        const auto number = [&](std::string_view word, double most) {
          return parse_whole_numbers(word, {.name = "part", .help = "", .limits = within(1, most)},
                                     subject)
              .at(0);
        };
        job.parts = number(words[1], 1'000'000);
        job.part = number(words[0], job.parts);
      });
}

SweepSummary run(const SweepJob& job, const Reporter& reporter, const RunCallback& on_run,
                 Team* team) {
  const auto start = std::chrono::steady_clock::now();
  if (job.runs.empty())
    throw UsageError("`sweep.vary`", "there is nothing to run",
                     "Give `sweep.vary=energy=500eV,1keV`, say");
  if (job.parts < 1 || job.part < 1 || job.part > job.parts)
    throw UsageError("`sweep.part`", fmt::format("{}/{} is no part", job.part, job.parts),
                     "Write 3/16 for the third of 16");
  const std::string sweep = sweep_identity(job);
  SweepSummary summary;
  summary.table =
      job.folder / (job.parts == 1 ? std::string("sweep.csv")
                                   : fmt::format("sweep.{}-of-{}.csv", job.part, job.parts));
  together(team, [&] {
    if (!leads(team)) return;
    io::check_writable(summary.table);
    refuse_another_sweep(job, sweep);
  });
  std::vector<std::size_t> mine;
  for (std::size_t i = static_cast<std::size_t>(job.part) - 1; i < job.runs.size();
       i += static_cast<std::size_t>(job.parts))
    mine.push_back(i);
  const std::vector<std::size_t> missing = find_missing(job, mine, sweep, team);
  summary.found = summary.done = mine.size() - missing.size();
  ManyRuns runs;
  runs.weights.assign(missing.size(), 1);
  runs.make = [&](std::size_t i) { return job.runs[missing[i]].make(); };
  runs.outcome = [&](std::size_t i, const SimulateJob& run, const SimulateSummary& s) {
    return record_of(job, missing[i], run, sweep, s);
  };
  runs.finished = [&](std::size_t i, const std::string& text) {
    io::write_text(record_path(job.folder, missing[i]), text);
    const Json record = Json::parse(text);
    if (record["missed"] > 0) ++summary.untrustworthy;
    ++summary.done;
    std::vector<SweepYield> yields;
    for (const Json& y : record["yields"])
      yields.push_back({y["detector"], y["mean"], y["standard_error"]});
    if (on_run) on_run(missing[i], yields);
  };
  runs.folder = job.folder;
  together(team, [&] {
    if (!missing.empty()) describe(job.runs[missing.front()].make(), runs);
  });
  runs.reporter = reporter;
  runs.reporter.on_progress = [&](double done, double, std::string_view things) {
    if (things == "cascades") return;  // the progress counts runs
    reporter.progress(static_cast<double>(summary.found) + done, static_cast<double>(mine.size()));
  };
  const ManyDone done = run_many(runs, team);
  summary.complete = done.complete;
  if (!summary.complete) return summary;
  together(team, [&] {
    if (!leads(team)) return;
    std::map<std::size_t, Json> records;
    for (const std::size_t number : mine)
      records[number + 1] = *read_record(record_path(job.folder, number));
    io::write_text(summary.table, table_of(records));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (team)
      io::write_text(sidecar_path(summary.table),
                     team_record(*team, done, seconds.count(), runs.threads, job.command_line));
  });
  return summary;
}

fs::path join_sweep(const std::vector<fs::path>& folders) {
  if (folders.empty())
    throw UsageError("FOLDER", "no folder is named",
                     "Name those that 'semsurf sweep --part' wrote to");
  std::map<std::size_t, Json> records;
  std::string sweep, from;
  std::size_t all = 0;
  for (const fs::path& folder : folders) {
    std::error_code ignored;
    if (!fs::is_directory(folder / "records", ignored))
      throw FileError(folder.string(), "there are no records of a sweep",
                      "Name a folder that 'semsurf sweep' wrote to");
    for (const auto& entry : fs::directory_iterator(folder / "records")) {
      const auto record = read_record(entry.path());
      if (!record || !record->contains("sweep")) continue;
      if (sweep.empty()) {
        sweep = (*record)["sweep"];
        all = (*record)["of"];
        from = folder.string();
      }
      if ((*record)["sweep"] != sweep)
        throw InvalidInput(folder.string(), fmt::format("it holds another sweep than {}", from),
                           "Join the parts of one sweep: the same `sweep.vary` in the same order");
      records[(*record)["number"]] = *record;
    }
  }
  std::vector<std::size_t> missing;
  for (std::size_t i = 1; i <= all; ++i)
    if (!records.contains(i)) missing.push_back(i);
  if (missing.empty() && !records.empty()) {
    const fs::path table = folders.front() / "sweep.csv";
    io::write_text(table, table_of(records));
    return table;
  }
  const std::size_t shown = std::min<std::size_t>(missing.size(), 10);
  throw InvalidInput(from.empty() ? folders.front().string() : from,
                     fmt::format("{} of {} runs are missing: {}{}", missing.size(), all,
                                 fmt::join(std::span(missing).first(shown), ", "),
                                 shown < missing.size() ? " ..." : ""),
                     "Run their parts again, which does only those, or name their folders too");
}

}  // namespace surf::workflow
