// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "surf/mc/cascades/library_source.h"
#include "surf/profile/profile_library.h"
#include "surf/workflow/profile_job.h"

namespace surf::workflow {

/// How an image looks at the walls.
struct ProfileView {
  double pixel_nm = 1, tilt_deg = 0, azimuth_deg = 0, energy_ev = 1000;
  std::string signal = "SE";
  /// Of a cut through a hole, from x: a tilted beam leans along it, and azimuth is that against it.
  double cut_deg = 0;

  friend bool operator==(const ProfileView&, const ProfileView&) = default;
  bool by_side_detector() const { return signal != "SE" && signal != "BSE"; }
  /// Whether left and right walls give other signals.
  bool one_sided() const;
  /// Whether it shows the same signal at the same energy as that image.
  bool shows_as(const ProfileView& other) const {
    return signal == other.signal && energy_ev == other.energy_ev;
  }
  /// Whether walls give the same signals as in that image.
  bool sees_as(ProfileView other) const;
};

/// One library of cascades for each energy, whoever asks.
class SharedLibraries : public mc::LibrarySource {
 public:
  SharedLibraries(mc::LibrarySource& source, int threads) : source_(&source), threads_(threads) {}
  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings& settings,
                                                    std::size_t wanted, int,
                                                    const Watch& watch) override;

 private:
  struct Kept {
    double energy_ev = 0;
    std::size_t size = 0;
    std::shared_ptr<const mc::CascadeLibrary> library;
  };
  mc::LibrarySource* source_;
  int threads_;
  std::vector<Kept> kept_;
  std::mutex mutex_;
};

/// The box of the first library, about the width that thresholds give.
ProfileBox first_box(const ProfileJob& job, double width_nm);
/// A smaller box about what was found.
ProfileBox next_box(const ProfileBox& before, const ProfileBox& first, const ProfileFit& fit);

/// Whether a number lies further from the box's middle than this share of its half sizes and than
/// its own error, where the first box goes on: no quadratic function holds so far away.
bool leaves(const ProfileFit& fit, const ProfileBox& box, const ProfileBox& first, double share);

/// Simulated signals of a box's shapes across one wall, the middle shape's first.
struct Signals {
  ProfileBox box;
  double first_u_nm = 0, step_nm = 1, blurred_by_nm = 0;
  std::vector<ProfileNumbers> shapes;
  std::vector<std::vector<double>> signals;
  FinerMiddle middle;

  ProfileLibrary library() const;
  /// Of one shape alone.
  ProfileLibrary alone(std::size_t shape) const;
};

/// Of the walls with the ground at their left, and at their right: by the same random numbers, so
/// that they differ by their shapes alone, on the level of the middle one's by many more. Where
/// both walls give one signal, the second is empty. `coarse`: at half the places.
struct WallSignals {
  Signals left, right;
};
WallSignals simulate_signals(const ProfileJob& job, const ProfileView& view, const ProfileBox& box,
                             double pitch_nm, std::int64_t electrons, std::uint64_t seed,
                             bool coarse, mc::LibrarySource& libraries, const Watch& watch);

/// The shape whose signals alone are most like the images, gains, offsets and places fitted.
struct MatchedShape {
  ProfileBox box;  ///< about it: over a wide box no quadratic function holds
  /// Images in which left and right walls the other way round make a shape that is clearly more
  /// like them: the beam was tilted to the other side, or a detector at the other side saw them.
  std::vector<std::size_t> other_side;
};
MatchedShape matched_shape(const ProfileJob& job, const std::vector<ProfileSight>& sights,
                           const std::vector<WallSignals>& signals,
                           const ProfileFitOptions& options, const Watch& watch);

}  // namespace surf::workflow
