// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/compare_steps.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

/// The job without its surfaces.
CompareJob parameters_of(const CompareJob& job) {
  CompareJob out;
  out.parameters = job.parameters;
  out.model = job.model;
  out.folder = job.folder;
  out.picture = job.picture;
  return out;
}

Record record_of_job(const CompareJob& job) {
  return job.of_image() ? record_of(parameters_of(job)) : record_of(job.parameters);
}

std::map<std::string, std::string> made_by(const CompareJob& job) {
  std::vector<std::filesystem::path> inputs;
  for (const auto& file : {job.before_file, job.after_file})
    if (!file.empty()) inputs.push_back(file);
  return step_record("compare", record_of_job(job), inputs);
}

Image change_image(const CompareSummary& s, std::map<std::string, std::string> made) {
  Image image;
  image.placement() = s.difference.placement();
  image.metadata = std::move(made);
  const auto add = [&](const char* what, const std::string& unit, const auto& values) {
    Channel channel{what, unit, Grid<float>(values.width(), values.height())};
    for (std::size_t i = 0; i < values.size(); ++i)
      channel.values.data()[i] =
          s.difference.valid.includes(i) ? static_cast<float>(values.data()[i]) : 0.0F;
    image.channels.push_back(std::move(channel));
  };
  const std::string in = s.unit == "nm" ? "nm" : "grey level";
  add("difference", s.unit, s.difference.difference);
  add("deviation", s.unit, s.changes.deviation);
  add("probability", "1", s.changes.probability);
  add("place", "1", s.changes.place);
  add("before", in, s.before.values);
  add("after", in, s.after.values);
  Mask valid(s.difference.difference.width(), s.difference.difference.height());
  for (std::size_t i = 0; i < valid.size(); ++i) valid.data()[i] = s.difference.valid.includes(i);
  add("valid", "1", valid);
  return image;
}

std::string places_csv(const CompareSummary& s) {
  const std::string unit = s.unit == "nm" ? "nm" : "percent";
  const std::string volume = s.unit == "nm" ? "nm3" : "percent_nm2";
  std::string text = fmt::format(
      "place,x_nm,y_nm,area_nm2,samples,mean_{0},mean_error_{0},largest_{0},volume_{1},"
      "volume_error_{1},deviations,probability\n",
      unit, volume);
  int number = 0;
  for (const ChangedPlace& p : s.changes.places)
    text +=
        fmt::format("{},{:.4f},{:.4f},{:.6g},{},{:.6g},{:.4g},{:.6g},{:.6g},{:.4g},{:.4g},{:.6g}\n",
                    ++number, p.centre_nm.x, p.centre_nm.y, p.area_nm2, p.samples, p.mean,
                    p.mean_error, p.largest, p.volume, p.volume_error, p.score, p.probability);
  return text;
}

Json places_json(const CompareSummary& s) {
  Json out = Json::array();
  for (const ChangedPlace& p : s.changes.places)
    out.push_back({{"centre_nm", {p.centre_nm.x, p.centre_nm.y}},
                   {"area_nm2", p.area_nm2},
                   {"mean", {{"value", p.mean}, {"standard_error", p.mean_error}}},
                   {"volume", {{"value", p.volume}, {"standard_error", p.volume_error}}},
                   {"largest", p.largest},
                   {"deviations", p.score},
                   {"probability", p.probability}});
  return out;
}

Json registration_json(const CompareSummary& s) {
  if (s.pose) {
    const Affine& a = s.pose->sem_to_afm;
    Json json{{"image_to_surface", {{a.xx, a.xy, a.x0}, {a.yx, a.yy, a.y0}}}};
    if (s.pose->registration) {
      const Registration& r = *s.pose->registration;
      json["verdict"] = name(r.verdict);
      json["score"] = number(r.score);
      json["standard_error_px"] = number(r.stderr_px);
    }
    return json;
  }
  const SurfaceAlignment& a = s.alignment;
  Json json{
      {"shift_nm", {number(a.shift_nm.x), number(a.shift_nm.y)}},
      {"shift_error_nm", {number(std::sqrt(a.covariance[0])), number(std::sqrt(a.covariance[6]))}},
      {"lift_nm", number(a.lift_nm)},
      {"lift_error_nm", number(std::sqrt(a.covariance[12]))},
      {"tilt", {number(a.tilt_x), number(a.tilt_y)}},
      {"correlation", number(a.correlation)},
      {"overlap", number(a.overlap)}};
  return json;
}

std::string report(const CompareJob& job, const CompareSummary& s) {
  Json json;
  json["semsurf_version"] = version();
  json["command"] = job.command_line;
  json["before"] = job.before_file.filename().string();
  json["after"] = job.after_file.filename().string();
  json["verdict"] = name(s.verdict);
  json["trusted"] = s.reasons.empty();
  json["reasons"] = s.reasons;
  json["warnings"] = s.warnings;
  json["registration"] = registration_json(s);
  if (s.verdict != CompareVerdict::not_registered) {
    const Changes& c = s.changes;
    if (s.pose) json["image"] = {{"gain", s.gain}, {"offset", s.offset}, {"contrast", s.contrast}};
    json["unit"] = s.unit;
    json["deviations_from"] = s.deviation_from;
    if (c.spread > 0) json["spread_over_stated"] = c.spread;
    else json["estimated_deviation"] = c.estimated_deviation;
    json["false_alarms"] = job.parameters.false_alarms;
    json["threshold_in_deviations"] = c.threshold;
    json["simulated_fields"] = c.simulations;
    json["windows_px"] = c.sizes_px;
    json["places"] = places_json(s);
  }
  json["parameters"] = Json::object();
  for (const auto& [key, value] : record_of_job(job)) json["parameters"][key] = value;
  // Paths need not be UTF-8. Such bytes are replaced, so that the report is not lost.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::vector<std::filesystem::path> write_comparison(const CompareJob& job,
                                                    const CompareSummary& s) {
  std::filesystem::create_directories(job.folder);
  std::vector<std::filesystem::path> written;
  const auto path = [&](const char* file) {
    written.push_back(job.folder / file);
    return written.back();
  };
  // Of an earlier run; what says whether a result is to be trusted comes last.
  for (const char* file : {"report.json", "change.vti", "places.csv", "panel.png"})
    std::filesystem::remove(job.folder / file);
  if (s.verdict != CompareVerdict::not_registered) {
    const auto made = made_by(job);
    io::write_image(path("change.vti"), change_image(s, made));
    io::write_text(path("places.csv"), places_csv(s));
    if (job.picture) {
      io::Plot plot = compare_picture(job, s);
      plot.metadata = made;
      io::write_plot(path("panel.png"), plot);
    }
  }
  io::write_text(path("report.json"), report(job, s));
  return written;
}

}  // namespace surf::workflow
