// SPDX-License-Identifier: GPL-3.0-or-later
#include "chart_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "kept_point.h"
#include "surf/io/files.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const ChartChannel& c) {
  const ImageError& e = c.error;
  return {{"channel", c.name},
          {"pixels", e.pixels},
          {"mean_signal", e.mean_signal},
          {"mean", e.mean},
          {"rms", e.rms},
          {"percentile95", e.percentile95},
          {"largest", e.largest},
          {"bias", e.bias},
          {"noise", e.noise},
          {"reference_noise", e.reference_noise},
          {"beyond_noise", e.beyond_noise}};
}

ChartChannel channel_of(const Json& j) {
  ChartChannel c{j.at("channel"), {}};
  ImageError& e = c.error;
  e.pixels = j.at("pixels");
  e.mean_signal = j.at("mean_signal");
  e.mean = j.at("mean");
  e.rms = j.at("rms");
  e.percentile95 = j.at("percentile95");
  e.largest = j.at("largest");
  e.bias = j.at("bias");
  e.noise = j.at("noise");
  e.reference_noise = j.at("reference_noise");
  e.beyond_noise = j.at("beyond_noise");
  return c;
}

Json to_json(const ChartPoint& p) {
  Json j{{"id", p.id},
         {"family", p.family},
         {"setting", p.setting},
         {"run_s", p.run_s},
         {"preparation_s", p.preparation_s},
         {"peak_bytes", p.peak_bytes},
         {"primaries", p.primaries},
         {"default", p.is_default}};
  for (const ChartChannel& c : p.channels) j["errors"].push_back(to_json(c));
  for (const ChartTarget& t : p.targets)
    j["targets"].push_back(
        {{"accuracy", t.accuracy}, {"rms", t.rms}, {"short", t.short_of}, {"met", t.met}});
  return j;
}

ChartPoint point_of(const Json& j) {
  ChartPoint p;
  p.id = j.at("id");
  p.family = j.at("family");
  p.setting = j.at("setting");
  p.run_s = j.at("run_s");
  p.preparation_s = j.at("preparation_s");
  p.peak_bytes = j.at("peak_bytes");
  p.primaries = j.at("primaries");
  p.is_default = j.at("default");
  for (const Json& c : j.at("errors")) p.channels.push_back(channel_of(c));
  for (const Json& t : j.at("targets"))
    p.targets.push_back({t.at("accuracy"), t.at("rms"), t.at("short"), t.at("met")});
  return p;
}

std::string quoted(const std::string& text) { return '"' + text + '"'; }

}  // namespace

void write_point(const std::filesystem::path& path, const ChartPoint& point,
                 const std::string& identity) {
  keep_point(path, identity, to_json(point));
}

std::optional<ChartPoint> read_point(const std::filesystem::path& path,
                                     const std::string& identity) {
  const auto json = kept_point(path, identity);
  try {
    if (json) return point_of(*json);
  } catch (const Json::exception&) {
  }
  return std::nullopt;
}

double read_seconds(const std::filesystem::path& path) {
  const auto json = read_json(path);
  return json && json->contains("seconds") && (*json)["seconds"].is_number()
             ? (*json)["seconds"].get<double>()
             : 0;
}

void write_seconds(const std::filesystem::path& path, double seconds) {
  io::write_text(path, Json{{"seconds", seconds}}.dump() + "\n");
}

std::string csv_text(const ChartSummary& summary) {
  std::string text =
      "id,family,setting,channel,run_s,preparation_s,peak_mb,primaries,mean,rms,percentile95,"
      "largest,bias,noise,"
      "reference_noise,beyond_noise,default\n";
  for (const ChartPoint& p : summary.points)
    for (const ChartChannel& c : p.channels) {
      const ImageError& e = c.error;
      text += fmt::format(
          "{},{},{},{},{:.4g},{:.4g},{:.4g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:."
          "6g},{}\n",
          p.id, p.family, quoted(p.setting), c.name, p.run_s, p.preparation_s, p.peak_bytes / 1e6,
          p.primaries, e.mean, e.rms, e.percentile95, e.largest, e.bias, e.noise, e.reference_noise,
          e.beyond_noise, p.is_default ? 1 : 0);
    }
  return text;
}

std::string json_text(const ChartJob& job, const ChartSummary& summary) {
  Json j{{"program", std::string("semsurf ") + version()},
         {"command", job.command_line},
         {"title", job.scene.title},
         {"parameters", records_of(job, static_cast<const mc::SimulationRequest&>(job.scene))},
         {"complete", summary.complete},
         {"compared_pixels", summary.compared},
         {"reference", {{"accuracy", job.reference_accuracy}}},
         {"points", Json::array()},
         {"choices", Json::array()},
         {"left_out", summary.left_out}};
  for (const ChartChannel& c : summary.reference) j["reference"]["errors"].push_back(to_json(c));
  for (const ChartPoint& p : summary.points) j["points"].push_back(to_json(p));
  for (const ChartChoice& c : summary.choices)
    j["choices"].push_back({{"accuracy", c.accuracy},
                            {"reason", c.reason},
                            {"chosen", c.id},
                            {"met", c.met},
                            {"fastest", c.fastest},
                            {"time_over_fastest", c.ratio}});
  return j.dump(1) + "\n";
}

std::vector<std::filesystem::path> chart_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const char* name : {"chart.csv", "chart.json", "chart.svg", "chart.png", "chart.run.json",
                           "reference", "points", "models"})
    files.push_back(folder / name);
  return files;
}

}  // namespace surf::workflow
