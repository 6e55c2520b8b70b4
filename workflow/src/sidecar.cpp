// SPDX-License-Identifier: GPL-3.0-or-later
#include "sidecar.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <nlohmann/json.hpp>

#include "surf/core/parallel.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

using Json = nlohmann::ordered_json;

std::string utc(std::chrono::system_clock::time_point t) {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(t.time_since_epoch()) %
                  std::chrono::seconds(1);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(t)), ms.count());
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  return usage.ru_maxrss;
#else
  return std::int64_t{usage.ru_maxrss} * 1024;
#endif
}

Json balance_json(const mc::Balance& b) {
  Json lost = Json::object();
  for (int i = 0; i < mc::loss_causes; ++i)
    lost[mc::name(static_cast<mc::LossCause>(i))] = b.lost[static_cast<std::size_t>(i)];
  return {{"electrons",
           {{"incident", b.incident},
            {"missed", b.missed},
            {"generated", b.generated},
            {"se", b.se},
            {"bse", b.bse},
            {"transmitted", b.transmitted},
            {"absorbed", b.absorbed},
            {"handed_over", b.handed_over},
            {"lost", lost}}},
          {"energy_ev",
           {{"incident", b.incident_energy.ev()},
            {"generated", b.generated_energy.ev()},
            {"escaped", b.escaped_energy.ev()},
            {"deposited", b.deposited_energy.ev()},
            {"lost", b.lost_energy.ev()}}}};
}

Json scene_json(const mc::SceneSummary& s) {
  return {{"triangles", s.triangles},
          {"triangles_left_out", s.triangles_left_out},
          {"shells", s.shells},
          {"memory_bytes", s.memory_bytes},
          {"grid_cell_nm", s.grid_cell_nm},
          {"build_seconds", s.build_seconds}};
}

Json simplification_json(const Simplification& s) {
  Json bodies = Json::array();
  for (const SimplifiedBody& b : s.bodies)
    bodies.push_back({{"name", b.name},
                      {"triangles_before", b.triangles_before},
                      {"triangles_after", b.triangles_after},
                      {"deviation_nm", b.deviation_nm},
                      {"kept", b.kept}});
  return {{"tolerance_nm", s.tolerance_nm}, {"seconds", s.seconds}, {"bodies", bodies}};
}

Json method_json(const ResolvedJob& job, const SimulateSummary& s) {
  Json pixels = Json::object();
  for (int i = 0; i < mc::pixel_models; ++i)
    pixels[mc::name(static_cast<mc::PixelModel>(i))] =
        s.statistics.models[static_cast<std::size_t>(i)];
  Json json = {{"name", mc::name(job.options.method)},
               {"reason", s.choice.reason},
               {"pixels", pixels},
               {"electrons_per_pixel",
                {{"mean", s.statistics.mean_electrons},
                 {"fewest", s.statistics.fewest_electrons},
                 {"most", s.statistics.most_electrons}}}};
  if (s.result.library_cascades > 0)
    json["library"] = {{"cascades", s.result.library_cascades},
                       {"pages_from_cache", s.pages_loaded},
                       {"pages_made", s.pages_made},
                       {"seconds", s.result.library_seconds}};
  if (const double accuracy = mc::accuracy_of(s.result.budget); accuracy > 0)
    json["accuracy"] = {
        {"asked", accuracy}, {"pixels_missed", s.statistics.missed}, {"worst", s.statistics.worst}};
  if (!s.gains.empty()) {
    Json detectors = Json::object();
    for (std::size_t d = 0; d < s.gains.size(); ++d)
      detectors[s.result.detectors[d].name] = {{"error", s.gains[d].error_share},
                                               {"plain_error", s.gains[d].plain_share}};
    json["guided"] = {{"by", s.guided_by}, {"rounds", s.rounds}, {"detectors", detectors}};
  }
  if (job.seconds() > 0) json["seconds_allowed"] = job.seconds();
  return json;
}

Json charging_json(const Charging& c) {
  Json json = {
      {"materials", c.materials}, {"leaving_per_primary", c.leaving}, {"net_per_primary", c.net()}};
  if (c.current_pa > 0) json["net_per_nm2"] = c.per_nm2;
  return json;
}

// The leader's own work is the work that no other member did.
Json team_json(const SimulateSummary& s, int threads) {
  Json ranks = Json::array();
  std::int64_t others = 0;
  for (const TeamMember& m : s.team) others += m.primaries;
  for (const TeamMember& m : s.team)
    ranks.push_back(
        {{"rank", m.rank},
         {"host", m.host},
         {"threads", m.rank == 0 ? threads : m.threads},
         {"units", m.units},
         {"primaries",
          m.rank == 0 ? s.result.balance.incident - s.result.recalled - others : m.primaries},
         {"waiting_seconds", m.waiting_s},
         {"bytes_sent", m.bytes_sent},
         {"messages", m.messages},
         {"messaging_seconds", m.messaging_s}});
  return ranks;
}

Json files_json(const RunRecord& record, const char* which) {
  Json files = Json::array();
  if (std::string(which) == "inputs")
    for (const InputHash& input : record.inputs)
      files.push_back({{"path", input.path.string()}, {"sha256", input.sha256}});
  else
    for (const auto& path : record.outputs) files.push_back(path.string());
  return files;
}

}  // namespace

std::filesystem::path sidecar_path(const std::filesystem::path& output) {
  std::filesystem::path path = output;
  path.replace_extension(".run.json");
  return path;
}

std::string sidecar_text(const ResolvedJob& job, const SimulateSummary& summary,
                         const RunRecord& record) {
  const mc::SimulationResult& result = summary.result;
  const mc::Balance& b = result.balance;
  const double per_second =
      result.seconds > 0 ? double(b.incident - result.recalled) / result.seconds : 0;

  Json json;
  json["semsurf"] = version();
  json["libraries"] = library_versions();
  json["command"] = job.command_line;
  json["parameters"] = parameters_of(job);
  json["complete"] = result.complete;
  json["inputs"] = files_json(record, "inputs");
  json["outputs"] = files_json(record, "outputs");
  json["host"] = host_name();
  json["threads"] = resolve_threads(job.options.threads);
  if (!summary.team.empty())
    json["ranks"] = team_json(summary, resolve_threads(job.options.threads));
  json["tile_pixels"] = job.options.tile_pixels;
  json["start"] = utc(record.start);
  json["end"] = utc(record.end);
  json["seconds"] = result.seconds;
  json["primaries"] = b.incident;
  json["primaries_from_checkpoint"] = result.recalled;
  json["primaries_per_second"] = per_second;
  json["rays"] = b.rays;
  json["steps"] = b.steps;
  json["peak_memory_bytes"] = peak_memory_bytes();
  json["method"] = method_json(job, summary);
  json["scene"] = scene_json(summary.scene);
  if (summary.simplification.tolerance_nm > 0)
    json["simplification"] = simplification_json(summary.simplification);
  json["balance"] = balance_json(b);
  if (summary.tier) json["tier"] = *summary.tier;
  if (summary.charging) json["charging"] = charging_json(*summary.charging);
  json["physics"] = Json::object();
  for (const mc::Material& material : job.scene.specimen.materials)
    json["physics"][material.name] = mc::describe(job.scene.physics, material);
  json["warnings"] = summary.warnings;
  // Paths need not be UTF-8. Such bytes are replaced, so that the record is not lost.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace surf::workflow
