// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <numbers>
#include <string>
#include <vector>

#include "common_parameters.h"
#include "surf/core/units.h"
#include "surf/mc/request/scan_request.h"
#include "surf/reconstruction/sample_surfaces.h"
#include "surf/workflow/sample_job.h"

namespace surf::workflow {
namespace {

constexpr double degree = std::numbers::pi / 180;

}  // namespace

void describe(ParameterVisitor& visit, SampleJob& job) {
  std::string names;
  for (const SampleScene& scene : sample_scenes()) names += (names.empty() ? "" : "|") + scene.name;
  visit(job.name, {.name = "sample.name", .help = "The surface", .form = names});
  describe_folder(visit, job.folder, "Folder for the files, created if it is missing");
  visit(job.electrons, {.name = "sample.electrons",
                        .help = "Primaries per pixel of the SEM image",
                        .limits = within(1, double(std::int64_t{1} << 31))});
  visit.form(
      {.name = "sample.size",
       .help = "Pixels of the SEM image, the middle of the view",
       .form = "WxH"},
      [&] { return fmt::format("{}x{}", job.width, job.height); },
      [&](std::string_view text, const std::string& subject) {
        mc::ScanRequest scan;
        read_parameters(scan, [&](const Parameter& about, Field& field) {
          if (about.name == "scan.size") field.read(text, subject);
        });
        job.width = *scan.width, job.height = *scan.height;
      });
  describe(visit, job.physics);
  visit(
      job.tip_lean_deg,
      {.name = "sample.tip_lean",
       .help =
           "Lean of the tip: its half angle is wider by this on one side and narrower on the other",
       .unit = Unit::deg,
       .limits = within(-60, 60)});
  visit(job.tip_azimuth_deg, {.name = "sample.tip_azimuth",
                              .help = "Direction of the tip's wider side, anticlockwise from +x",
                              .unit = Unit::deg});
  visit(job.gain_drift, {.name = "sample.gain_drift",
                         .help = "Share by which the SEM's gain drifts over the image, as charging "
                                 "makes it",
                         .limits = within(-0.5, 0.5)});
  visit(job.spot_nm, {.name = "sample.spot",
                      .help = "Standard deviation of the beam's spot",
                      .unit = Unit::nm,
                      .limits = within(0, 1000),
                      .otherwise = "that of the models of these scenes"});
  visit(job.detector, {.name = "sample.detector",
                       .help = "Detector of secondaries in place of one that sees all of them: "
                               "in-lens, side, or one of your own, as simulate reads it",
                       .otherwise = "all of them",
                       .form = "NAME"});
  visit(job.film, {.name = "sample.film",
                   .help = "Material of a film that covers the specimen",
                   .otherwise = "none",
                   .form = "MATERIAL"});
  visit(job.film_nm, {.name = "sample.film_thickness",
                      .help = "Thickness of this film",
                      .unit = Unit::nm,
                      .limits = within(0.1, 10)});
  visit(job.scan_drift_px,
        {.name = "sample.scan_drift",
         .help = "Displacement of the scan's first and last rows against its middle, in pixels of "
                 "the SEM image",
         .limits = within(-20, 20)});
  visit(job.line_jitter_px, {.name = "sample.line_jitter",
                             .help = "Standard deviation of displacements of the SEM image's rows, "
                                     "in pixels",
                             .limits = within(0, 5)});
  visit(job.seed, {.name = "sample.seed",
                   .help = "Seed of noise and simulation: the same seed gives the same files"});
  describe_cache(visit, job.cache);
  describe_threads(visit, job.threads);
}

const std::vector<SampleScene>& sample_scenes() {
  const auto scene = [](const char* name, AffineParts map, double radius_nm,
                        double half_angle_deg) {
    SampleScene s;
    s.name = name;
    s.what = find_sample_surface(name).what;
    s.sem_to_afm = map;
    s.tip_radius_nm = radius_nm;
    s.tip_half_angle_deg = half_angle_deg;
    return s;
  };
  static const std::vector<SampleScene> all = [&] {
    // Rotation, scales, tangent of the shear.
    std::vector<SampleScene> s{scene("nist0523-thick", {7 * degree, 1.02, 0.985, 0.012}, 75, 28),
                               scene("nist0523-thin", {183 * degree, 0.97, 1.01, -0.02}, 60, 25),
                               scene("pads", {94 * degree, 1.035, 1.01, 0.015}, 70, 28),
                               scene("islands", {-31 * degree, 0.955, 0.98, 0.03}, 80, 27),
                               scene("terrain", {19 * degree, 1.01, 1.045, -0.01}, 65, 26)};
    constexpr double margins[][4] = {{360, 300, 310, 420},
                                     {300, 440, 380, 320},
                                     {330, 300, 300, 460},
                                     {300, 340, 320, 300},
                                     {420, 310, 300, 350}};
    constexpr double tilts[][3] = {
        {0.45, -0.2, 312}, {-0.3, 0.4, -75}, {0.1, 0.5, 1040}, {-0.5, -0.1, 6}, {0.25, 0.4, 150}};
    for (std::size_t i = 0; i < s.size(); ++i) {
      s[i].margin_left_nm = margins[i][0], s[i].margin_right_nm = margins[i][1];
      s[i].margin_bottom_nm = margins[i][2], s[i].margin_top_nm = margins[i][3];
      s[i].tilt_x_deg = tilts[i][0], s[i].tilt_y_deg = tilts[i][1],
      s[i].afm_offset_nm = tilts[i][2];
    }
    return s;
  }();
  return all;
}

}  // namespace surf::workflow
