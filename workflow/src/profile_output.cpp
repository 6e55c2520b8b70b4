// SPDX-License-Identifier: GPL-3.0-or-later
#include "profile_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/plot.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }
Json measured(const Measured& m) {
  return {{"value", number(m.value)}, {"standard_error", number(m.standard_error)}};
}

Json wall_json(const std::array<Measured, profile_numbers>& wall) {
  return {{"height_nm", measured(wall[profile_height])},
          {"angle_deg", measured(wall[profile_angle])},
          {"top_radius_nm", measured(wall[profile_top])},
          {"foot_radius_nm", measured(wall[profile_foot])}};
}

Json roughness_json(const EdgeRoughness& r) {
  return {{"more_than_noise", r.found},
          {"three_sigma_nm",
           {{"value", number(3 * r.sigma_nm)}, {"standard_error", number(3 * r.sigma_error_nm)}}},
          {"correlation_length_nm", number(r.correlation_nm)},
          {"hurst_exponent", number(r.hurst)},
          {"noise_of_a_place_nm", number(r.noise_nm)},
          {"three_sigma_with_noise_nm", number(3 * r.biased_sigma_nm)}};
}

Json report(const ProfileJob& job, const ProfileSummary& s) {
  Json json = {{"semsurf_version", version()},     {"image", job.sem.file.filename().string()},
               {"kind", name(job.kind)},           {"material", job.material.name},
               {"energy_ev", job.energy_ev},       {"spot_nm", job.spot_nm},
               {"simulated_pitch_nm", s.pitch_nm}, {"simulated_profiles", s.simulated}};
  for (const SemInput& view : job.views) json["views"].push_back(view.file.filename().string());
  if (s.scan_height_nm) {
    json["scan"] = job.scan_file.filename().string();
    json["scan_height_nm"] = measured(*s.scan_height_nm);
  }
  if (s.hole) json["hole"] = {{"x_nm", s.hole->x_nm}, {"y_nm", s.hole->y_nm}};
  if (job.kind != FeatureKind::edge) json["width_nm"] = measured(s.fit.left[profile_width]);
  if (s.measured_pitch_nm) json["pitch_nm"] = measured(*s.measured_pitch_nm);
  if (job.walls_apart) {
    json["left_wall"] = wall_json(s.fit.left);
    json["right_wall"] = wall_json(s.fit.right);
  } else {
    json["wall"] = wall_json(s.fit.left);
  }
  for (const Measured& w : s.fit.widths_nm) json["widths_nm"].push_back(measured(w));
  for (const Measured& w : s.threshold_widths_nm)
    json["threshold_method"]["widths_nm"].push_back(measured(w));
  json["threshold_method"]["threshold"] = job.threshold;
  if (!s.fit.edge_spectrum.density_nm3.empty())
    json["edge_roughness"] = roughness_json(s.fit.edge_roughness);
  if (!s.fit.width_spectrum.density_nm3.empty())
    json["width_roughness"] = roughness_json(s.fit.width_roughness);
  json["gain"] = s.fit.sights.front().gain;
  json["offset"] = s.fit.sights.front().offset;
  json["unexplained_share"] = s.fit.sights.front().discrepancy_share;
  for (std::size_t k = 1; k < s.fit.sights.size(); ++k) {
    const SightFit& view = s.fit.sights[k];
    json["fitted_views"].push_back({{"tilt_deg", measured(view.tilt_deg)},
                                    {"gain", view.gain},
                                    {"offset", view.offset},
                                    {"unexplained_share", view.discrepancy_share}});
  }
  json["trusted"] = s.reasons.empty();
  json["reasons"] = s.reasons;
  json["parameters"] = Json::object();
  for (const auto& [key, value] : record_of(job)) json["parameters"][key] = value;
  return json;
}

std::string edges_csv(const ProfileSummary& s) {
  std::string text = "row";
  for (std::size_t e = 0; e < s.fit.edges().size(); ++e)
    text += fmt::format(",edge_{0}_nm,edge_{0}_error_nm,edge_{0}_threshold_nm", e + 1);
  text += "\n";
  const std::size_t rows = s.fit.edges().front().rows_nm.size();
  for (std::size_t r = 0; r < rows; ++r) {
    text += std::to_string(r);
    for (std::size_t e = 0; e < s.fit.edges().size(); ++e) {
      const auto& threshold = s.threshold.places_nm[e];
      const double error = s.fit.edges()[e].errors_nm[r];  // none: the row does not show the edge
      text += std::isfinite(error)
                  ? fmt::format(",{:.4f},{:.4f},", s.fit.edges()[e].rows_nm[r], error)
                  : ",,,";
      // Directions about a hole are others there.
      if (!s.hole && r < threshold.size() && std::isfinite(threshold[r]))
        text += fmt::format("{:.4f}", threshold[r]);
    }
    text += "\n";
  }
  return text;
}

/// Where the wall is of its feature: that at the left of a line has the material at its right, that
/// at the left of a gap the other way round.
const char* wall_name(const ProfileJob& job, const MeanProfile& m) {
  return m.material_right == (job.kind != FeatureKind::trench) ? "left" : "right";
}

std::string profiles_csv(const ProfileJob& job, const ProfileSummary& s) {
  std::string text = "wall,u_nm,measured,standard_error,fitted\n";
  for (std::size_t p = 0; p < s.fit.sights.front().profiles.size(); ++p) {
    const MeanProfile& m = s.fit.sights.front().profiles[p];
    for (std::size_t i = 0; i < m.u_nm.size(); ++i)
      text += fmt::format("{},{:.4f},{:.6g},{:.6g},{:.6g}\n", wall_name(job, m), m.u_nm[i],
                          m.measured[i], m.standard_error[i], m.fitted[i]);
  }
  return text;
}

std::string spectrum_csv(const ProfileSummary& s) {
  std::string text = "frequency_per_nm,edge_density_nm3,edge_fitted_nm3,width_density_nm3\n";
  const EdgeSpectrum& e = s.fit.edge_spectrum;
  for (std::size_t i = 0; i < e.frequency_per_nm.size(); ++i) {
    text += fmt::format(
        "{:.6g},{:.6g},{:.6g},", e.frequency_per_nm[i], e.density_nm3[i],
        roughness_density(s.fit.edge_roughness, e.frequency_per_nm[i], s.row_distance_nm));
    if (i < s.fit.width_spectrum.density_nm3.size())
      text += fmt::format("{:.6g}", s.fit.width_spectrum.density_nm3[i]);
    text += "\n";
  }
  return text;
}

io::PlotPanel image_panel(const ProfileSummary& s, const PlacedImage& image) {
  io::PlotPanel panel;
  panel.title = "edges in the image";
  panel.x.label = "x (nm)";
  panel.y.label = "y (nm)";
  io::PlotImage picture;
  picture.values = image.values;
  picture.pitch_x = image.pitch_x_nm, picture.pitch_y = image.pitch_y_nm;
  picture.origin_x = image.x_nm(0), picture.origin_y = image.y_nm(0);
  picture.label = "signal";
  panel.image = std::move(picture);
  for (std::size_t e = 0; e < s.edge_lines_nm.size(); ++e) {
    io::PlotSeries line;
    for (const Point2& place : s.edge_lines_nm[e])
      line.x.push_back(place.x), line.y.push_back(place.y);
    line.color = s.fit.edges()[e].edge.material_right ? 1 : 2;
    panel.series.push_back(std::move(line));
  }
  return panel;
}

io::PlotPanel profile_panel(const ProfileJob& job, const ProfileSummary& s, std::size_t sight) {
  io::PlotPanel panel;
  panel.title = sight == 0 ? "mean profile, measured and fitted"
                           : fmt::format("mean profile of view {}, tilted by {:.2f}°", sight + 1,
                                         s.fit.sights[sight].tilt_deg.value);
  const std::vector<MeanProfile>& profiles = s.fit.sights[sight].profiles;
  panel.x.label = "from the wall's middle, material to the right (nm)";
  panel.y.label = "signal";
  for (std::size_t p = 0; p < profiles.size(); ++p) {
    const MeanProfile& m = profiles[p];
    const std::string wall =
        profiles.size() == 1 ? "" : fmt::format(" ({} walls)", wall_name(job, m));
    panel.series.push_back({"measured" + wall, m.u_nm, m.measured, {}, io::PlotStyle::points});
    panel.series.push_back({"fitted" + wall, m.u_nm, m.fitted, {}});
  }
  return panel;
}

io::PlotPanel shape_panel(const ProfileJob& job, const ProfileSummary& s) {
  io::PlotPanel panel;
  panel.title = "cross-section";
  panel.x.label = "x (nm)";
  panel.y.label = "z (nm)";
  const auto add = [&](const std::array<Measured, profile_numbers>& w, const char* title) {
    io::PlotSeries line;
    line.name = title;
    const double beside = 0.3 * w[profile_height].value;
    line.x.push_back(-beside), line.y.push_back(0);
    for (const Point2& p : wall_profile({w[profile_height].value, w[profile_angle].value,
                                         w[profile_top].value, w[profile_foot].value}))
      line.x.push_back(p.x), line.y.push_back(p.y);
    line.x.push_back(line.x.back() + beside), line.y.push_back(w[profile_height].value);
    panel.series.push_back(std::move(line));
  };
  add(s.fit.left, job.walls_apart ? "left wall" : "wall");
  if (job.walls_apart) add(s.fit.right, "right wall, mirrored");
  return panel;
}

io::PlotPanel spectrum_panel(const ProfileSummary& s) {
  io::PlotPanel panel;
  panel.title = "spectrum of the edges";
  panel.x = {"frequency (1/nm)", true, {}};
  panel.y = {"power density (nm³)", true, {}};
  const EdgeSpectrum& e = s.fit.edge_spectrum;
  io::PlotSeries seen{"edges as found", {}, {}, {}, io::PlotStyle::points},
      all{"roughness and noise", {}, {}, {}}, rough{"roughness alone", {}, {}, {}};
  EdgeRoughness quiet = s.fit.edge_roughness;
  quiet.noise_nm = 0;
  for (std::size_t i = 0; i < e.frequency_per_nm.size(); ++i) {
    const double f = e.frequency_per_nm[i];
    const auto push = [f](io::PlotSeries& to, double value) {
      if (value > 0) to.x.push_back(f), to.y.push_back(value);
    };
    push(seen, e.density_nm3[i]);
    push(all, roughness_density(s.fit.edge_roughness, f, s.row_distance_nm));
    if (s.fit.edge_roughness.found) push(rough, roughness_density(quiet, f, s.row_distance_nm));
  }
  panel.series = {seen, all};
  if (!rough.x.empty()) panel.series.push_back(rough);
  return panel;
}

std::vector<std::filesystem::path> inputs_of(const ProfileJob& job) {
  std::vector<std::filesystem::path> files{job.sem.file};
  for (const SemInput& view : job.views) files.push_back(view.file);
  if (!job.scan_file.empty()) files.push_back(job.scan_file);
  return files;
}

Image surface_image(const ProfileSummary& s, const std::map<std::string, std::string>& made) {
  Image image;
  image.placement() = s.surface.placement();
  image.metadata = made;
  const auto add = [&](const char* what, const Grid<double>& values) {
    Channel channel{what, "nm", Grid<float>(values.width(), values.height())};
    std::ranges::copy(values.data(), channel.values.data().begin());
    image.channels.push_back(std::move(channel));
  };
  add("z_nm", s.surface.z_nm);
  add("deviation_nm", s.deviation_nm);
  return image;
}

}  // namespace

std::vector<std::filesystem::path> write_profile(const ProfileJob& job, const ProfileSummary& s) {
  std::filesystem::create_directories(job.folder);
  std::vector<std::filesystem::path> written;
  const auto path = [&](const char* file) {
    written.push_back(job.folder / file);
    return written.back();
  };
  // Of an earlier run; what says whether a result is to be trusted comes last.
  for (const char* file : {"profile.json", "spectrum.csv", "panel.png"})
    std::filesystem::remove(job.folder / file);
  io::write_text(path("edges.csv"), edges_csv(s));
  io::write_text(path("profiles.csv"), profiles_csv(job, s));
  const bool spectrum = !s.fit.edge_spectrum.density_nm3.empty();
  if (spectrum) io::write_text(path("spectrum.csv"), spectrum_csv(s));
  const std::map<std::string, std::string> made =
      step_record("profile", record_of(job), inputs_of(job));
  io::write_height_field(path("surface.gsf"), s.surface, made);
  io::write_image(path("surface.vti"), surface_image(s, made));
  const auto finish = [&] {
    io::write_text(path("profile.json"), report(job, s).dump(2) + "\n");
    return written;
  };
  if (!job.picture) return finish();
  io::Plot plot;
  plot.panels = {image_panel(s, job.sem.image), profile_panel(job, s, 0), shape_panel(job, s)};
  for (std::size_t k = 1; k < s.fit.sights.size(); ++k)
    plot.panels.push_back(profile_panel(job, s, k));
  if (spectrum) plot.panels.push_back(spectrum_panel(s));
  plot.columns = 2;
  plot.width_px = 1800;
  plot.metadata = made;
  io::write_plot(path("panel.png"), plot);
  return finish();
}

}  // namespace surf::workflow
