// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "geometry/gun.h"
#include "geometry/scene_impl.h"
#include "replay/replay.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/request/simulation_options.h"

namespace surf::mc {

/// What all primaries of a pixel have in common.
struct ReplaySite {
  Gun::Start middle;                ///< of the pixel's beam
  bool single = false;              ///< all primaries start there
  bool hit = false;                 ///< whether the middle of the beam meets the specimen
  SceneGeometry::State before = 0;  ///< where it flies
  SceneGeometry::Surface surface;   ///< where it meets it
  FlatSurroundings<SceneGeometry::State> flat;
  int material = -1;                          ///< behind the surface
  std::shared_ptr<const LocalSurface> patch;  ///< null where nobody looked, or all is flat
};

/// Replays primaries in a scene, on one thread.
class SiteReplay {
 public:
  SiteReplay(const Scene::Impl& scene, const SimulationOptions& options,
             const Libraries& libraries);

  /// Looks at the surface under a pixel. Flat surroundings are looked for where many primaries will
  /// make up for it.
  ReplaySite site(int x, int y, bool look_around);

  /// Replays a primary at a site; true if it met the specimen. `start` is asked for where the site
  /// is not single. Counts are in `detection()`, all else in `balance()`.
  bool run(const ReplaySite& site, const Gun::Start& start, const ReplayedPrimary& primary);

  /// The next primaries are at this site.
  void go_to(const ReplaySite& site) { replay_.surroundings(site.flat, site.patch.get()); }

  /// The primary after the next one at this site replays this cascade.
  void fetch(const ReplaySite& site, std::size_t cascade) const {
    if (site.material >= 0) replay_.fetch(site.material, cascade);
  }

  const Gun& gun() const { return gun_; }
  Detection& detection() { return detection_; }
  Balance& balance() { return balance_; }

  /// Whether the surface around the site is a plane as far as any electron gets: nothing else can
  /// be met. Then only its direction counts.
  bool proved_plane(const ReplaySite& site);

  /// Farther than any electron gets inside a material.
  double range_nm(int material) const;

  /// Of the library that cascades in this material come from; null where direct simulation follows
  /// its electrons.
  const CascadeLibrary* library(int material) const {
    return libraries_[static_cast<std::size_t>(material)].get();
  }

 private:
  ReplaySite site_alone(int x, int y);
  void find_plane(ReplaySite& site) const;
  std::shared_ptr<const LocalSurface> patch(int x, int y, const ReplaySite& site);

  const Scene::Impl& scene_;
  Libraries libraries_;
  SceneGeometry geometry_;
  Gun gun_;
  Detection detection_;
  Balance balance_;
  NoObserver nobody_;
  Transport<SceneGeometry, NoObserver> direct_;
  Replay<SceneGeometry> replay_;
  struct KnownPlane {
    Vec3 normal;
    double offset;
    bool top;
  };
  std::vector<KnownPlane> planes_;
  struct BlockSurface {
    Vec3 normal;
    std::shared_ptr<const LocalSurface> patch;  // null where the beam meets nothing
  };
  int block_;         // of pixels to a side that may share a patch
  double shared_nm_;  // apart at most
  std::map<std::pair<int, int>, BlockSurface> patches_;
};

}  // namespace surf::mc
