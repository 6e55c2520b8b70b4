// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "surf/core/progress.h"
#include "surf/core/vec3.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/request/simulation_options.h"
#include "surf/mc/transport/tally.h"

namespace surf::mc {

/// What every cascade of a library gives on a plane.
struct PlanarControl {
  Vec3 normal;               ///< out of the matter; the beam comes along `beam`
  std::uint64_t number = 0;  ///< stands for the pixel in the cascades' random numbers
  std::vector<std::vector<std::uint8_t>> counts;  ///< per detector, per cascade
  std::vector<Counts> sums;                       ///< per detector, over all cascades
};

/// The planes that pixels are compared with: one for each direction of the surface, in steps of
/// some degrees, and the very plane where a pixel's surface is proved to be one. Made when first
/// asked for; safe to use from many threads.
class PlanarControls {
 public:
  PlanarControls(const Scene::Impl& scene, const SimulationOptions& options,
                 const Libraries& libraries, const CancelToken* cancel);
  ~PlanarControls();

  /// The control for a surface of this material and outward normal, and the azimuth, in turns, by
  /// which the control's cascades are turned about the beam to lie in that surface as in the
  /// control's. `exact`: of just this normal, but for the azimuth where it does not count.
  struct Match {
    std::shared_ptr<const PlanarControl> control;
    double azimuth = 0;
  };
  /// Throws Interrupted.
  Match match(int material, const Vec3& normal, bool exact);

  /// Cascades of a library.
  std::size_t cascades() const { return cascades_; }

  /// Stands for the control that `match` would give.
  using Key = std::tuple<int, std::int64_t, std::int64_t, std::int64_t>;
  Key key(int material, const Vec3& normal, bool exact) const {
    return place(material, normal, exact).key;
  }

  /// Controls made so far, and the wall time of that on the threads that made them.
  struct Made {
    std::size_t planes = 0;
    double seconds = 0;
  };
  Made made() const;
  /// Wall time that the calling thread has spent in making controls, or waiting for one that
  /// another made: not the work of the pixel that happened to be first.
  static double seconds_of_this_thread();

  /// A cascade's azimuth, in turns, about the beam in its control.
  static double azimuth(std::uint64_t seed, std::size_t cascade);

 private:
  struct Slot;
  struct Place {
    Key key;
    Vec3 plane;          ///< the control's normal
    double azimuth = 0;  ///< as in Match
  };

  Place place(int material, const Vec3& normal, bool exact) const;
  std::shared_ptr<const PlanarControl> make(int material, const Vec3& normal,
                                            std::uint64_t number) const;

  const Scene::Impl& scene_;
  const SimulationOptions& options_;
  const Libraries& libraries_;
  const CancelToken* cancel_;   // or null; making a control lasts seconds
  bool axial_;                  // detectors and beam do not care for azimuths
  Vec3 across_, up_, against_;  // the beam's frame; `against_` points back at the gun
  std::size_t cascades_ = 0;
  mutable std::mutex mutex_;
  Made made_;
  std::map<Key, std::shared_ptr<Slot>> slots_;
};

}  // namespace surf::mc
