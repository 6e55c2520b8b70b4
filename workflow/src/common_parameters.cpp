// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_parameters.h"

#include <fmt/ranges.h>

#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/core/units.h"
#include "surf/core/words.h"
#include "surf/io/cache.h"
#include "surf/mc/request/simulation_request.h"
#include "surf/mc/simulate.h"

namespace surf::workflow {

void describe_threads(ParameterVisitor& visit, int& threads) {
  mc::Execution execution;
  execution.threads = threads;
  describe(visit, execution);
  threads = execution.threads;
}

void describe_images(ParameterVisitor& visit, std::vector<std::filesystem::path>& outputs,
                     const char* help) {
  visit.form(
      {.name = "output",
       .help = help,
       .form = "FILE",
       .recorded = false,
       .file = FileRole::written},
      [&] { return outputs.empty() ? std::string() : outputs.front().string(); },
      [&](std::string_view text, const std::string&) { outputs.emplace_back(text); },
      FieldKind::list);
}

void describe_folder(ParameterVisitor& visit, std::filesystem::path& folder, const char* help) {
  visit.form(
      {.name = "output",
       .help = help,
       .form = "FOLDER",
       .recorded = false,
       .file = FileRole::written_folder},
      [&] { return folder.string(); },
      [&](std::string_view text, const std::string&) {
        folder = text;
        // Removes the slash of "result/".
        while (folder.filename().empty() && folder.has_parent_path()) folder = folder.parent_path();
      });
}

void describe_path(ParameterVisitor& visit, std::filesystem::path& path, const Parameter& about) {
  visit.form(
      about, [&] { return path.string(); },
      [&](std::string_view text, const std::string&) { path = text; });
}

std::string exact_list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ",") + format_exact(value);
  return text;
}

void describe_numbers(ParameterVisitor& visit, std::vector<double>& values,
                      const Parameter& about) {
  visit.form(
      about, [&] { return exact_list(values); },
      [&](std::string_view text, const std::string& subject) {
        const std::vector<double> more = parse_values(text, about, subject);
        values.insert(values.end(), more.begin(), more.end());
      },
      FieldKind::list);
}

void describe_names(ParameterVisitor& visit, std::vector<std::string>& names,
                    const Parameter& about) {
  visit.form(
      about, [&] { return fmt::format("{}", fmt::join(names, ",")); },
      [&](std::string_view text, const std::string&) {
        const auto parts = split(text, ",");
        names.assign(parts.begin(), parts.end());
      });
}

void describe_cache(ParameterVisitor& visit, std::filesystem::path& cache) {
  visit.form(
      {.name = "job.cache",
       .help = "Folder that libraries of cascades are kept in for other runs, or off",
       .otherwise = "$SEMSURF_CACHE, ~/.cache/semsurf",
       .form = "FOLDER|off",
       .level = Level::advanced,
       .recorded = false},
      [&] { return cache.string(); },
      [&](std::string_view text, const std::string&) {
        cache = io::cache_folder(std::string(text));
      });
}

void describe_point(ParameterVisitor& visit, std::optional<std::pair<double, double>>& point_nm,
                    Parameter about) {
  about.unit = Unit::nm;
  about.form = "X,Y";
  visit.form(
      about,
      [&] {
        return point_nm ? fmt::format("{},{}", format_exact(point_nm->first),
                                      format_exact(point_nm->second))
                        : std::string();
      },
      [&](std::string_view text, const std::string& subject) {
        const auto parts = split(text, ",");
        if (parts.size() != 2)
          throw UsageError(subject, "it is not a point", "Write two lengths, X,Y");
        point_nm = {parse_length_nm(parts[0], subject), parse_length_nm(parts[1], subject)};
      });
}

void describe_picture(ParameterVisitor& visit, bool& picture) {
  bool no_picture = !picture;
  visit(no_picture, {.name = "output.no_picture",
                     .help = "Leave out panel.png, which needs Python with Matplotlib",
                     .recorded = false});
  picture = !no_picture;
}

void describe_beam(ParameterVisitor& visit, double& energy_ev, double& spot_nm,
                   mc::Physics& physics) {
  mc::SimulationRequest request;
  request.beam.energy_ev = energy_ev;
  request.beam.spot_nm = spot_nm;
  request.physics = physics;
  describe_some(
      visit, request,
      {{.name = "beam.energy", .otherwise = "required"}, {"beam.spot"}, {"simulation.physics"}});
  if (!visit.reads()) return;
  energy_ev = request.beam.energy_ev;
  spot_nm = request.beam.spot_nm;
  physics = request.physics;
}

}  // namespace surf::workflow
