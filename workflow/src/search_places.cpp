// SPDX-License-Identifier: GPL-3.0-or-later
#include "search_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "chain_steps.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/reconstruction/tip_search.h"

namespace surf::workflow {
namespace {

constexpr double usual_radii_nm[] = {25, 75, 150};
constexpr double usual_half_angle_rad = 25 * std::numbers::pi / 180;
constexpr double elsewhere_px = 10;
constexpr std::size_t most_rivals = 3;  // of each search

Tip usual_tip(const HeightField& scan, double radius_nm) {
  constexpr int most_reach = 20;
  const auto size = [&](double pitch_nm, int samples) {
    const int reach = static_cast<int>(std::ceil(3 * radius_nm / pitch_nm));
    return 2 * std::clamp(reach, 2, std::min(most_reach, std::max(2, (samples - 1) / 4))) + 1;
  };
  return conical_tip(radius_nm, usual_half_angle_rad,
                     {scan.pitch_x_nm, scan.pitch_y_nm, size(scan.pitch_x_nm, scan.z_nm.width()),
                      size(scan.pitch_y_nm, scan.z_nm.height())});
}

void add_places(const Pose& pose, std::vector<Affine>& places) {
  places.push_back(pose.sem_to_afm);
  const auto& rivals = pose.registration->rivals;
  for (std::size_t i = 0; i < std::min(rivals.size(), most_rivals); ++i)
    places.push_back(rivals[i].sem_to_afm);
}

}  // namespace

double apart_px(const Affine& a, const Affine& b, const PlacedImage& sem) {
  double most = 0;
  for (const int x : {0, sem.values.width() - 1})
    for (const int y : {0, sem.values.height() - 1}) {
      const Point2 p = a({sem.x_nm(x), sem.y_nm(y)}), q = b({sem.x_nm(x), sem.y_nm(y)});
      most = std::max(most, std::hypot(p.x - q.x, p.y - q.y) / sem.pitch_x_nm);
    }
  return most;
}

bool go_to_likeliest_place(Pose& pose, const PoseOptions& options, const PreparedAfm& afm,
                           const PlacedImage& sem, const StoredModel& model, int threads,
                           const Reporter& reporter) {
  if (!pose.registration || pose.verified() || options.registration.start ||
      !options.landmarks.empty())
    return false;
  std::vector<Affine> places;
  add_places(pose, places);
  for (const double radius_nm : usual_radii_nm) {
    PreparedAfm other = afm;
    other.tip = usual_tip(afm.image, radius_nm);
    CertaintyOptions certainty;
    certainty.noise_nm = std::sqrt(afm.noise.variance_nm2());
    certainty.threads = threads;
    other.certainty = certainty_map(other.image, other.tip, certainty);
    try {
      const Pose there = pose_of(options, other, sem, model, threads, reporter);
      if (there.registration->verdict != RegistrationVerdict::unrelated) add_places(there, places);
    } catch (const InvalidInput&) {
      // Under such a tip the scan is a plane.
    }
  }
  begin(reporter, "places");
  std::size_t best = 0;
  double most = -1;
  for (std::size_t i = 0; i < places.size(); ++i) {
    double evidence = 0;
    try {
      evidence = place_evidence(afm.image, sem, *model.model, places[i], threads, reporter.watch());
    } catch (const InvalidInput&) {
      continue;  // hardly any overlap
    }
    if (evidence > most) most = evidence, best = i;
  }
  // The search for the tip moves the map by some pixels, too.
  if (apart_px(places[best], pose.sem_to_afm, sem) < elsewhere_px) return false;
  pose.sem_to_afm = places[best];
  reporter.note(
      "registration: at another place than the best of the first search the scan explains the SEM "
      "image better, under some tip");
  return true;
}

}  // namespace surf::workflow
