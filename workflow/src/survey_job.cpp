// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/survey_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "surf/afm/blind_tip.h"
#include "surf/afm/roughness.h"
#include "surf/afm/tip_measure.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/workflow/morphology_job.h"
#include "surf/workflow/noise_job.h"

namespace surf::workflow {
namespace {

constexpr double lowest_share = 0.005;

std::vector<double> sorted_heights(const HeightField& field) {
  std::vector<double> z;
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x)
      if (field.is_valid(x, y)) z.push_back(field.z_nm(x, y));
  std::ranges::sort(z);
  return z;
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * double(sorted.size() - 1))];
}

/// Area above a height, and the length of its border along the grid times pi / 4, which is right
/// on the average over directions.
struct Island {
  double area_nm2 = 0, border_nm = 0;
};

Island above(const HeightField& field, double height_nm) {
  Island out;
  const int w = field.z_nm.width(), h = field.z_nm.height();
  const auto high = [&](int x, int y) {
    return field.is_valid(x, y) && field.z_nm(x, y) > height_nm;
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (high(x, y)) out.area_nm2 += field.pitch_x_nm * field.pitch_y_nm;
      if (x + 1 < w && high(x, y) != high(x + 1, y)) out.border_nm += field.pitch_y_nm;
      if (y + 1 < h && high(x, y) != high(x, y + 1)) out.border_nm += field.pitch_x_nm;
    }
  constexpr double over_directions = 0.7853981633974483;
  out.border_nm *= over_directions;
  return out;
}

/// Of the scatter of some numbers; absent for fewer than two.
std::optional<double> scatter(const std::vector<double>& values) {
  if (values.size() < 2) return std::nullopt;
  double mean = 0, squares = 0;
  for (const double v : values) mean += v / double(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / double(values.size() - 1));
}

/// A blind tip's end is flat by as much as its threshold: fitted down to ten times that, or as deep
/// as a fit takes anyway.
std::optional<double> radius_of(const Tip& tip, double threshold_nm) {
  constexpr double thresholds = 10;
  try {
    TipMeasures m = measure_tip(tip);
    if (thresholds * threshold_nm > m.fit_depth_nm)
      m = measure_tip(tip, {.fit_depth_nm = thresholds * threshold_nm});
    const double radius = m.radius_nm;
    return std::isfinite(radius) && radius > 0 ? std::optional(radius) : std::nullopt;
  } catch (const InvalidInput&) {  // too few samples
    return std::nullopt;
  }
}

HeightField with_noise(const HeightField& field, const AfmNoise& noise, std::uint64_t seed) {
  HeightField out = field;
  const Grid<double> drawn = simulate_noise(noise, field.z_nm.width(), field.z_nm.height(), seed);
  for (std::size_t i = 0; i < drawn.size(); ++i) out.z_nm.data()[i] += drawn.data()[i];
  return out;
}

void add_problem(SurveyedScan& out, const std::string& problem) {
  out.problem += (out.problem.empty() ? "" : "; ") + problem;
}

/// Radius, its scatter, and what the tip adds to features.
void survey_tip(const HeightField& levelled, const std::vector<double>& sorted,
                const std::optional<AfmNoise>& noise, const SurveyParameters& parameters,
                TipParameters asked, const Reporter& reporter, SurveyedScan& out) {
  if (noise && !asked.noise) asked.noise = noise;
  const TipResult found = find_tip({levelled}, asked, reporter);
  if (!found.tip.doubt.empty()) add_problem(out, found.tip.doubt);
  const double threshold_nm = found.used.threshold_nm.value_or(0);
  out.tip_radius_nm = radius_of(found.tip, threshold_nm);
  if (!out.tip_radius_nm) {
    add_problem(out, "the tip's end is flat or hollow: no feature is sharp enough to show it");
    return;
  }
  if (const auto angle = measure_tip(found.tip).half_angle_rad)
    out.tip_half_angle_deg = *angle / degrees_to_radians;
  if (noise && found.used.threshold_nm) {
    TipParameters again = found.used;
    again.answer = TipAnswer::blind;
    std::vector<double> radii;
    for (int draw = 0; draw < parameters.draws; ++draw) {
      reporter.watch().check();
      const HeightField noisy = with_noise(levelled, *noise, asked.seed + std::uint64_t(draw) + 1);
      if (const auto radius = radius_of(find_tip({noisy}, again, {}).tip, threshold_nm))
        radii.push_back(*radius);
    }
    out.tip_radius_error_nm = scatter(radii);
    if (out.tip_radius_error_nm && *out.tip_radius_error_nm > *out.tip_radius_nm)
      add_problem(out, fmt::format("the tip's radius is not known: noise moves it by {}, more than "
                                   "it is",
                                   format_length(*out.tip_radius_error_nm)));
  }
  const double half_nm =
      0.5 * (quantile(sorted, lowest_share) + quantile(sorted, 1 - lowest_share));
  MorphologyParameters eroding;
  eroding.threads = asked.threads;
  const HeightField eroded = morphology(MorphologyOperation::erode, levelled,
                                        tip_for(found.tip, levelled, "tip"), eroding, {});
  const Island wide = above(levelled, half_nm), narrow = above(eroded, half_nm);
  // Grown by d, an area gets d times the mean of its old and new border (Steiner).
  if (wide.border_nm > 0)
    out.broadening_nm = 2 * (wide.area_nm2 - narrow.area_nm2) / (wide.border_nm + narrow.border_nm);
}

std::string field_of(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "";
}

/// In quotes where it must be (RFC 4180).
std::string text_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

/// Of a folder's files. Text may be anything: it counts where numbers are in it.
bool is_scan(const std::filesystem::path& path) {
  if (io::has_scan_name(path)) return true;
  if (!io::is_height_field_file(path)) return false;
  if (path.extension() != ".txt") return true;
  try {
    return !io::height_channels(path).empty();
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void describe(ParameterVisitor& visit, SurveyParameters& p) {
  visit(p.no_tip,
        {.name = "survey.no_tip", .help = "Leave out the tip, which takes nearly all of the time"});
  visit(p.draws, {.name = "survey.draws",
                  .help = "Draws of noise that the error of the tip's radius is taken from",
                  .limits = within(2, 1000)});
}

SurveyedScan survey_scan(const HeightField& scan, const SurveyParameters& parameters,
                         const LevelParameters& levelling, const TipParameters& tip,
                         const Reporter& reporter) {
  check_parameters(parameters);
  SurveyedScan out;
  out.width = scan.z_nm.width(), out.height = scan.z_nm.height();
  out.pitch_x_nm = scan.pitch_x_nm, out.pitch_y_nm = scan.pitch_y_nm;
  const LevelResult levelled = level(scan, levelling, {}, reporter);
  out.tilt_deg = levelled.tilt_deg;
  if (levelled.hough) out.substrate_share = levelled.hough->inlier_share;
  out.roughness_nm = measure_roughness(levelled.field, levelled.substrate).sq_levelled_nm;
  const std::vector<double> sorted = sorted_heights(levelled.field);
  out.relief_nm = quantile(sorted, 1 - lowest_share) - quantile(sorted, lowest_share);
  std::optional<AfmNoise> noise;
  try {
    const ScanNoise estimate = noise_of_scan(levelled.field, {}, {}, reporter);
    out.noise_nm = estimate.estimate.sigma_nm();
    if (estimate.estimate.noise.innovation_nm2 > 0) noise = estimate.estimate.noise;
  } catch (const InvalidInput& error) {
    add_problem(out, "noise: " + error.reason());
  }
  if (parameters.no_tip) return out;
  try {
    survey_tip(levelled.field, sorted, noise, parameters, tip, reporter, out);
  } catch (const InvalidInput& error) {
    add_problem(out, "tip: " + error.reason());
  }
  return out;
}

std::string survey_csv(std::span<const SurveyedScan> scans) {
  std::string out =
      "file,width,height,pitch_x_nm,pitch_y_nm,tilt_deg,substrate_share,roughness_nm,relief_nm,"
      "noise_nm,tip_radius_nm,tip_radius_error_nm,tip_half_angle_deg,broadening_nm,problem\n";
  for (const SurveyedScan& s : scans)
    out += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{},{},{},{}\n",
                       text_field(s.file.string()), s.width, s.height, s.pitch_x_nm, s.pitch_y_nm,
                       s.tilt_deg, s.substrate_share, s.roughness_nm, s.relief_nm,
                       field_of(s.noise_nm), field_of(s.tip_radius_nm),
                       field_of(s.tip_radius_error_nm), field_of(s.tip_half_angle_deg),
                       field_of(s.broadening_nm), text_field(s.problem));
  return out;
}

std::vector<std::filesystem::path> scans_of(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::filesystem::path> out;
  for (const std::filesystem::path& path : paths) {
    if (!std::filesystem::is_directory(path)) {
      out.push_back(path);
      continue;
    }
    std::vector<std::filesystem::path> inside;
    for (const auto& entry : std::filesystem::directory_iterator(path))
      if (entry.is_regular_file() && is_scan(entry.path())) inside.push_back(entry.path());
    if (inside.empty())
      throw FileError(path.string(), "no scan is in this folder",
                      "Give the scans themselves: images of heights are not sought in folders");
    std::ranges::sort(inside);
    out.insert(out.end(), inside.begin(), inside.end());
  }
  return out;
}

}  // namespace surf::workflow
