// SPDX-License-Identifier: GPL-3.0-or-later
#include "chain_chart_files.h"

#include <fmt/format.h>

#include "surf/workflow/version.h"
#include "thesis_points.h"

namespace surf::workflow {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json to_json(const CaptureRange& r) {
  return {{"family", r.family},      {"any_start", r.any_start},     {"px", number_or_null(r.px)},
          {"px_or_more", r.px_open}, {"deg", number_or_null(r.deg)}, {"deg_or_more", r.deg_open},
          {"median_s", r.median_s}};
}

}  // namespace

Json to_json(const RegistrationPoint& p) {
  return {{"id", p.id},
          {"family", p.family},
          {"offset_px", p.offset_px},
          {"offset_deg", p.offset_deg},
          {"any_start", p.any_start},
          {"draws", p.draws},
          {"verified", p.verified},
          {"right", p.right},
          {"wrong", p.wrong},
          {"median_px", p.median_px},
          {"largest_px", p.largest_px},
          {"median_s", p.median_s}};
}

void from_json(const Json& j, RegistrationPoint& p) {
  p.id = j.at("id");
  p.family = j.at("family");
  p.offset_px = j.at("offset_px");
  p.offset_deg = j.at("offset_deg");
  p.any_start = j.at("any_start");
  p.draws = j.at("draws");
  p.verified = j.at("verified");
  p.right = j.at("right");
  p.wrong = j.at("wrong");
  p.median_px = j.at("median_px");
  p.largest_px = j.at("largest_px");
  p.median_s = j.at("median_s");
}

Json to_json(const ReconstructionPoint& p) {
  Json j{{"id", p.id},
         {"family", p.family},
         {"setting", p.setting},
         {"default", p.is_default},
         {"preparation_s", p.preparation_s},
         {"peak_bytes", p.peak_bytes},
         {"iterations", p.iterations},
         {"evaluations", p.evaluations},
         {"products", p.products},
         {"ended", p.ended},
         {"steps", Json::array()}};
  for (const ReconstructionStep& s : p.steps)
    j["steps"].push_back({{"sigma_px", s.sigma_px}, {"run_s", s.run_s}, {"rms_nm", s.rms_nm}});
  return j;
}

void from_json(const Json& j, ReconstructionPoint& p) {
  p.id = j.at("id");
  p.family = j.at("family");
  p.setting = j.at("setting");
  p.is_default = j.at("default");
  p.preparation_s = j.at("preparation_s");
  p.peak_bytes = j.at("peak_bytes");
  p.iterations = j.at("iterations");
  p.evaluations = j.at("evaluations");
  p.products = j.at("products");
  p.ended = j.at("ended");
  for (const Json& s : j.at("steps"))
    p.steps.push_back({s.at("sigma_px"), s.at("run_s"), s.at("rms_nm")});
  p.steps.at(0);  // every point has a step
}

std::string registration_csv(const ChainChartSummary& summary) {
  std::string text =
      "id,family,offset_px,offset_deg,draws,verified,right,wrong,median_px,largest_px,median_s\n";
  for (const RegistrationPoint& p : summary.registrations)
    text += fmt::format("{},{},{},{},{},{},{},{},{:.6g},{:.6g},{:.4g}\n", p.id, p.family,
                        p.any_start ? "" : fmt::format("{:g}", p.offset_px),
                        p.any_start ? "" : fmt::format("{:g}", p.offset_deg), p.draws, p.verified,
                        p.right, p.wrong, p.median_px, p.largest_px, p.median_s);
  return text;
}

std::string reconstruction_csv(const ChainChartSummary& summary) {
  std::string text =
      "id,family,setting,sigma_px,run_s,preparation_s,peak_mb,rms_nm,over_eroded,over_floor,"
      "default\n";
  for (const ReconstructionPoint& p : summary.reconstructions)
    for (const ReconstructionStep& s : p.steps)
      text += fmt::format("{},{},\"{}\",{:.6g},{:.4g},{:.4g},{:.4g},{:.6g},{:.6g},{:.6g},{}\n",
                          p.id, p.family, p.setting, s.sigma_px, s.run_s, p.preparation_s,
                          p.peak_bytes / 1e6, s.rms_nm, s.rms_nm / summary.eroded_nm,
                          s.rms_nm / summary.floor_nm, p.is_default ? 1 : 0);
  return text;
}

std::string chain_json(const ChainChartJob& job, const ChainChartSummary& summary) {
  Json j{{"program", std::string("semsurf ") + version()},
         {"command", job.command_line},
         {"sample", summary.sample},
         {"complete", summary.complete},
         {"parameters", record_of(job)},
         {"right_px", right_px},
         {"registrations", Json::array()},
         {"capture_ranges", Json::array()},
         {"reconstructions", Json::array()},
         {"eroded_nm", summary.eroded_nm},
         {"floor_nm", summary.floor_nm > 0 ? Json(summary.floor_nm) : Json()},
         {"left_out", summary.left_out},
         {"thesis", Json::array()}};
  for (const RegistrationPoint& p : summary.registrations) j["registrations"].push_back(to_json(p));
  for (const CaptureRange& r : summary.ranges) j["capture_ranges"].push_back(to_json(r));
  for (const ReconstructionPoint& p : summary.reconstructions)
    j["reconstructions"].push_back(to_json(p));
  for (const ThesisPoint& t : thesis_points)
    j["thesis"].push_back({{"test", t.test},
                           {"afm_squares", t.afm_squares},
                           {"both_squares", t.both_squares},
                           {"hours", t.hours},
                           {"source", thesis_source}});
  return j.dump(1) + "\n";
}

std::vector<std::filesystem::path> chain_chart_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files{folder / "chart.json", folder / "points"};
  for (const char* name : {"registration", "reconstruction"})
    for (const char* extension : {".csv", ".svg", ".png"})
      files.push_back(folder / (std::string(name) + extension));
  return files;
}

}  // namespace surf::workflow
