// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/trajectories.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "extras.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/track_picture.h"
#include "surf/io/tracks_file.h"
#include "surf/mc/transport/track_recorder.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/section.h"

namespace surf::workflow {
namespace {

constexpr int probe_primaries = 100;  // enough to find how far electrons get
constexpr double exit_share = 0.35;   // share of that distance to which leaving electrons are drawn

struct Pixel {
  int x, y;
};

Pixel pixel_at(const mc::Scan& scan, const std::optional<std::pair<double, double>>& at_nm) {
  if (!at_nm) return {scan.width / 2, scan.height / 2};
  const double x = (at_nm->first - scan.center_x_nm) / scan.pixel_x_nm + 0.5 * scan.width;
  const double y = (at_nm->second - scan.center_y_nm) / scan.pixel_y_nm + 0.5 * scan.height;
  if (!(x >= 0 && x < scan.width && y >= 0 && y < scan.height))
    throw UsageError(
        "`output.trajectories_at`",
        fmt::format("({:g}, {:g}) nm is outside the scan", at_nm->first, at_nm->second),
        "Give a point that the image shows");
  return {static_cast<int>(x), static_cast<int>(y)};
}

std::vector<Track> record(const mc::Scene& scene, std::uint64_t seed, const Pixel& p, int primaries,
                          double exit_nm) {
  mc::SimulationOptions options;
  options.seed = seed;
  mc::TrackRecorder recorder(exit_nm);
  mc::simulate_unit(scene, options, {p.x, p.y, p.x + 1, p.y + 1, 0, primaries}, &recorder);
  return std::move(recorder.tracks);
}

// The box around the primaries' paths inside matter. Their secondaries stay near them, except a few
// that fly to another part of the specimen.
Box box_inside(const std::vector<Track>& tracks) {
  Box box;
  for (const Track& t : tracks)
    for (std::size_t i = 0; i < t.material.size(); ++i)
      if (t.generation == 0 && t.material[i] >= 0) {
        box.extend(t.points_nm[i]);
        box.extend(t.points_nm[i + 1]);
      }
  return box;
}

double longest_side(const Box& box) {
  if (box.empty()) return 0;
  const Vec3 size = box.size_nm();
  return std::max({size.x, size.y, size.z});
}

std::vector<std::array<Vec3, 2>> outline(const mc::Specimen& specimen, double y_nm,
                                         double half_width_nm) {
  std::vector<std::array<Vec3, 2>> pieces;
  const auto add = [&](const TriangleMesh& mesh) {
    const auto more = section_at_y(mesh, y_nm);
    pieces.insert(pieces.end(), more.begin(), more.end());
  };
  if (specimen.substrate) {
    const double z = specimen.substrate->top_nm;
    pieces.push_back({Vec3{-half_width_nm, y_nm, z}, Vec3{half_width_nm, y_nm, z}});
  }
  if (specimen.height_field) add(height_field_sheet(specimen.height_field->field));
  for (const mc::Body& body : specimen.bodies) add(body.mesh);
  return pieces;
}

std::string materials_of(const mc::Specimen& specimen) {
  std::string names;
  for (const mc::Material& m : specimen.materials) names += (names.empty() ? "" : ", ") + m.name;
  return names;
}

}  // namespace

void check_trajectories(const ResolvedJob& job, const mc::Scan& scan) {
  if (job.extras.trajectories > 0) pixel_at(scan, job.extras.trajectories_at_nm);
}

Trajectories record_trajectories(const mc::Scene& scene, std::uint64_t seed, int primaries,
                                 const std::optional<std::pair<double, double>>& at_nm) {
  const mc::Scan& scan = scene.scan();
  const Pixel pixel = pixel_at(scan, at_nm);
  Trajectories t;
  t.inside_nm =
      longest_side(box_inside(record(scene, seed, pixel, std::min(primaries, probe_primaries), 0)));
  t.exit_nm = t.inside_nm > 0 ? exit_share * t.inside_nm : scan.width * scan.pixel_x_nm;
  t.tracks = record(scene, seed, pixel, primaries, t.exit_nm);
  return t;
}

void write_trajectories(const mc::Scene& scene, const ResolvedJob& job,
                        const std::map<std::string, std::string>& settings) {
  const int primaries = job.extras.trajectories;
  const auto [tracks, inside, exit_nm] =
      record_trajectories(scene, job.options.seed, primaries, job.extras.trajectories_at_nm);

  io::write_tracks(extra_path(job, ".tracks.vtp"), tracks, settings);
  io::TrackPictureOptions picture;
  picture.title = fmt::format("{} primaries of {:g} keV in {}", primaries,
                              scene.beam().energy_ev / 1000, materials_of(job.scene.specimen));
  picture.subtitle = job.scene.title;
  const Vec3& landing = tracks.front().points_nm.at(1);
  picture.outline_nm =
      outline(job.scene.specimen, landing.y, std::fabs(landing.x) + 10 * (inside + exit_nm));
  if (const Box box = box_inside(tracks); !box.empty()) {
    const double margin = 0.1 * longest_side(box);
    picture.window_nm = {box.lower_nm.x - margin, box.lower_nm.z - margin, box.upper_nm.x + margin,
                         box.upper_nm.z + exit_nm};
  }
  io::write_track_picture(extra_path(job, ".tracks.png"), tracks, picture);
}

}  // namespace surf::workflow
