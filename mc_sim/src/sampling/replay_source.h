// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "replay/planar_controls.h"
#include "replay/replay_site.h"
#include "sampling/cache_blocks.h"
#include "sampling/primaries_per_pixel.h"
#include "sampling/primary_source.h"
#include "sampling/stratified_permutation.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/mc/request/simulation_options.h"
#include "transport/random_streams.h"

namespace surf::mc {

/// Primaries that are stored cascades, of each pixel its own part of the library. With planar
/// controls, the same cascades on a plane are their control.
class ReplaySource {
 public:
  static constexpr PixelModel model = PixelModel::replay;
  static constexpr bool misses_are_known = true;

  /// `controls`: null, or what has been made of the same libraries.
  ReplaySource(const Scene::Impl& scene, const SimulationOptions& options,
               const Libraries& libraries, PlanarControls* controls)
      : options_(options), controls_(controls), numbers_(scene.scan, options),
        replay_(scene, options, libraries) {
    for (const auto& l : libraries)
      if (l) cascades_ = cascades_ == 0 ? l->cascades() : std::min(cascades_, l->cascades());
  }

  void begin(const SourceTask& task) {
    cancel_ = task.cancel;
    replay_.balance() = {};
    pixels_.clear();
    for (int y = task.unit.y0; y < task.unit.y1; ++y)
      for (int x = task.unit.x0; x < task.unit.x1; ++x) {
        check();  // the first pixel on a plane waits for its control
        const std::int64_t expected = task.expected.empty()
                                          ? std::numeric_limits<std::int64_t>::max()
                                          : task.expected[pixels_.size()];
        look(x, y, expected >= worth_looking_around);
      }
  }

  template <class Visit>
  void serve(std::span<const PrimaryRange> ranges, const Visit& visit) {
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      pixels_[i].used = ranges[i].first;
      pixels_[i].end = ranges[i].end;
    }
    by_blocks(pixels_, cascades_, replay_,
              [&](std::size_t i, std::uint64_t electron, std::size_t cascade) {
                check();
                run(i, electron, cascade, visit);
              });
  }

  void finish(UnitTally& tally) {
    tally.balance += replay_.balance();
    tally.spectra = replay_.detection().take_spectra();
  }

  /// No more than there are cascades.
  std::uint64_t most_primaries() const { return cascades_; }
  bool misses(std::size_t i) const { return pixels_[i].site.single && !pixels_[i].site.hit; }
  bool settled(std::size_t i) const { return pixels_[i].plane; }
  bool controlled(std::size_t i) const { return pixels_[i].match.control != nullptr; }
  Estimate control(std::size_t i, std::size_t d) const {
    if (!controlled(i)) return {};
    return estimate(static_cast<std::int64_t>(cascades_), pixels_[i].match.control->sums[d]);
  }

 private:
  static constexpr std::int64_t worth_looking_around = 8;  // primaries of a pixel

  struct Pixel {
    int x = 0, y = 0;
    std::uint64_t number = 0;
    ReplaySite site;
    PlanarControls::Match match;
    bool plane = false;  // and it is the very plane of the control
    StratifiedPermutation subset;
    std::uint64_t used = 0,
                  end = 0;  // of its primaries: the first to be served, and one past the last
  };

  void check() const {
    if (cancel_ && cancel_->cancelled()) throw Interrupted();
  }

  void look(int x, int y, bool around) {
    const std::uint64_t number = numbers_.number(x, y);
    RandomStream own(options_.seed, number, random_streams::order_of_cascades);
    const std::uint32_t a = own.bits(), b = own.bits();
    pixels_.push_back(
        {x,
         y,
         number,
         replay_.site(x, y, around),
         {},
         false,
         StratifiedPermutation(cascades_, a, b,
                               options_.odd_counts ? StratifiedPermutation::short_run
                                                   : StratifiedPermutation::long_run)});
    Pixel& p = pixels_.back();
    if (!controls_ || !p.site.hit || !options_.planar_control) return;
    p.plane = replay_.proved_plane(p.site);
    p.match = controls_->match(p.site.material, p.site.flat.normal, p.plane);
  }

  template <class Visit>
  void run(std::size_t i, std::uint64_t electron, std::size_t cascade, const Visit& visit) {
    const Pixel& p = pixels_[i];
    ReplayedPrimary primary{options_.seed, p.number, electron, cascade, 0};
    const PlanarControl* control = p.match.control.get();
    if (control) {
      // As in the control, so that where the surface is nearly the plane it gives nearly the same.
      primary.pixel = control->number;
      primary.electron = cascade;
      primary.azimuth = PlanarControls::azimuth(options_.seed, cascade) + p.match.azimuth;
    } else {
      primary.azimuth = azimuth_of(primary);
    }
    Gun::Start start = p.site.middle;
    if (!p.site.single) {
      RandomStream random(options_.seed, p.number, electron);
      start = replay_.gun().primary(p.x, p.y, random);
    }
    const bool hit = replay_.run(p.site, start, primary);
    visit(i, electron, hit, [&](std::size_t d) {
      return std::pair<int, int>(replay_.detection().counts()[d],
                                 control ? control->counts[d][cascade] : 0);
    });
    replay_.detection().end_primary();
  }

  const SimulationOptions& options_;
  PlanarControls* controls_;
  PrimariesPerPixel numbers_;
  SiteReplay replay_;
  std::size_t cascades_ = 0;
  const CancelToken* cancel_ = nullptr;
  std::vector<Pixel> pixels_;
};

static_assert(PrimarySource<ReplaySource>);

}  // namespace surf::mc
