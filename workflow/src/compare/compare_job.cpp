// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/compare_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chain_steps.h"
#include "compare/compare_steps.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/plot.h"
#include "surf/io/sem_file.h"

namespace surf::workflow {
namespace {

constexpr const char* deviation_channel = "deviation_nm";
// Errors so much larger than stated belong to another specimen, or to a wrong place.
constexpr double largest_spread = 5;
constexpr double told_spread = 1.1;

void check(const CompareJob& job) {
  check_parameters(job.parameters);
  check_results(job.folder, job.picture);
  if (std::holds_alternative<TriangleMesh>(job.before) &&
      !std::holds_alternative<MeasuredSurface>(job.after))
    throw UsageError(job.before_file.string(),
                     job.of_image() ? "an SEM image is compared with a measured surface"
                                    : "both files are meshes, which have no samples",
                     "Give heights on a grid, as 'semsurf mesh' makes them of a mesh");
}

/// Deviations that a file states, 0 where it states none.
Grid<double> deviations_of(const std::filesystem::path& file, const HeightField& field) {
  const HeightField read = io::read_height_field(file, {.channel = deviation_channel}).field;
  if (read.z_nm.width() != field.z_nm.width() || read.z_nm.height() != field.z_nm.height())
    throw InvalidInput(file.string(), "its deviations have another size than its heights",
                       "Give each height its deviation");
  Grid<double> out = read.z_nm;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!read.valid.includes(i)) out.data()[i] = 0;
    if (!field.valid.includes(i)) continue;
    if (!(out.data()[i] >= 0))
      throw InvalidInput(file.string(), "a standard deviation is below 0", "Correct the file");
  }
  return out;
}

}  // namespace

void warn(const std::string& text, const Reporter& reporter, CompareSummary& s) {
  s.warnings.push_back(text);
  reporter.warn(text);
}

CompareSummary run(const CompareJob& job, const Reporter& reporter) {
  check(job);
  CompareSummary s;
  double least_spread = 1;
  const bool registered = job.of_image() ? difference_from_image(job, reporter, s)
                                         : difference_of_surfaces(job, reporter, s, least_spread);
  if (registered) {
    begin(reporter, "noise");
    const CompareParameters& p = job.parameters;
    ChangeOptions options;
    options.false_alarms = p.false_alarms;
    options.smallest_px = p.smallest_px;
    options.largest_nm = p.largest_nm;
    options.simulations = p.simulations;
    options.least_spread = least_spread;
    options.seed = p.seed;
    options.threads = job.threads;
    options.watch = reporter.watch();
    s.changes = find_changes(s.difference, options);
    s.verdict = s.changes.places.empty() ? CompareVerdict::unchanged : CompareVerdict::changed;
    if (s.changes.spread > largest_spread)
      s.reasons.push_back(fmt::format(
          "they differ {:.1f} times as much as their deviations say, nearly everywhere: is it the "
          "same place of the same specimen, and are the deviations right?",
          s.changes.spread));
    else if (s.changes.spread > told_spread)
      warn(fmt::format("they differ {:.2f} times as much as their deviations say, nearly "
                       "everywhere: deviations are widened by that",
                       s.changes.spread),
           reporter, s);
  }
  begin(reporter, "files");
  if (!job.folder.empty()) s.written = write_comparison(job, s);
  return s;
}

ComparedSurface read_compared_surface(const std::filesystem::path& file,
                                      const io::HeightReadOptions& reading,
                                      const io::MeshUnit& unit, std::vector<std::string>& notes) {
  if (reading.channel.empty() && io::has_mesh_content(file)) return io::read_mesh(file, unit);
  if (!reading.z_unit_nm) io::refuse_as_heights(file);
  const io::HeightFile content(file);
  io::HeightFieldFile read = content.read(reading);
  for (const std::string& note : read.notes)
    notes.push_back(fmt::format("{}: {}", file.string(), note));
  MeasuredSurface out{std::move(read.field), {}};
  for (const io::HeightChannel& channel : content.channels())
    if (channel.name == deviation_channel) out.deviation_nm = deviations_of(file, out.field);
  return out;
}

const char* name(CompareVerdict verdict) {
  switch (verdict) {
    case CompareVerdict::unchanged:
      return "unchanged";
    case CompareVerdict::changed:
      return "changed";
    case CompareVerdict::not_registered:
      break;
  }
  return "not registered";
}

}  // namespace surf::workflow
