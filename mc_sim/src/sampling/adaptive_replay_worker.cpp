// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "replay/planar_controls.h"
#include "replay/replay_site.h"
#include "sampling/adaptive_sampling.h"
#include "sampling/cache_blocks.h"
#include "sampling/stratified_permutation.h"
#include "sampling/unit_worker.h"
#include "surf/core/random.h"
#include "transport/random_streams.h"

namespace surf::mc {

namespace {

// A plane's error takes no more of the target. Beside steep walls it would, and the difference could not
// make up for it.
constexpr double most_share = 0.9;

// With a wanted accuracy each pixel is served until it is reached. A pilot tells how much the counts
// scatter, by themselves and as differences to the outcome of the same cascades on a plane; then the
// number of primaries is set, and fresh ones are counted. The pilot's are not: who stops when the
// dice were good, or goes on because they were bad, gets the mean wrong.
class SpendingWorker : public UnitWorker {
 public:
  SpendingWorker(const Scene::Impl& scene, const SimulationOptions& options,
                 const Libraries& libraries, PlanarControls& controls)
      : scene_(scene), options_(options), controls_(controls), replay_(scene, options, libraries),
        detectors_(options.detectors.size()), cascades_(controls.cascades()) {}

  void simulate(const WorkUnit& unit, Observer*, UnitTally& out) override {
    clear(out, unit, detectors_);
    out.controls.assign(detectors_, Grid<Control>(unit.x1 - unit.x0, unit.y1 - unit.y0));
    replay_.balance() = {};
    unit_ = unit;
    sites_.assign(out.pixels.size(), {});
    for (std::size_t i = 0; i < sites_.size(); ++i) look(i);
    try_out();
    wanted_.assign(sites_.size(), 0);
    for (std::size_t i = 0; i < sites_.size(); ++i) choose(i, out);
    serve(out);
    out.balance += replay_.balance();
    out.spectra = replay_.detection().take_spectra();
  }

 private:
  struct Pixel {
    std::uint64_t number = 0;
    int x = 0, y = 0;
    ReplaySite site;
    PlanarControls::Match match;
    bool plane = false;               // nothing is left to simulate
    std::vector<Sample> plain, difference;   // the pilot's, then those that count; per detector
    StratifiedPermutation subset{StratifiedPermutation::run, 0, 0};
    std::uint64_t used = 0, end = 0;  // of its primaries: taken, and to be taken now
  };

  int width() const { return unit_.x1 - unit_.x0; }
  int height() const { return unit_.y1 - unit_.y0; }

  void look(std::size_t i) {
    check();   // the first pixel on a plane waits for its control
    Pixel& p = sites_[i];
    p.x = unit_.x0 + static_cast<int>(i) % width();
    p.y = unit_.y0 + static_cast<int>(i) / width();
    p.number = static_cast<std::uint64_t>(p.y) * static_cast<std::uint64_t>(scene_.scan.width) +
               static_cast<std::uint64_t>(p.x);
    p.site = replay_.site(p.x, p.y, true);
    RandomStream own(options_.seed, p.number, random_streams::order_of_cascades);
    const std::uint32_t a = own.bits(), b = own.bits();
    p.subset = StratifiedPermutation(cascades_, a, b);
    p.plain.resize(detectors_);
    p.difference.resize(detectors_);
    if (p.site.single && !p.site.hit) return;
    if (p.site.hit && options_.planar_control) {
      p.plane = replay_.proved_plane(p.site);
      p.match = controls_.match(p.site.material, p.site.flat.normal, p.plane);
    }
    if (!p.plane) p.end = pilot_primaries;
  }

  // Every pixel's primaries up to its `end`. take(pixel, hit, detector, counted, on the plane).
  template <class Take>
  void replay_all(const Take& take) {
    by_blocks(sites_, cascades_, replay_,
              [&](std::size_t i, std::uint64_t electron, std::size_t cascade) {
                run(sites_[i], electron, cascade,
                    [&](bool hit, const auto& counts) { take(i, hit, counts); });
              });
    for (Pixel& p : sites_) p.used = std::max(p.used, p.end);
  }

  void try_out() {
    replay_all([&](std::size_t i, bool, const auto& counts) {
      Pixel& p = sites_[i];
      for (std::size_t d = 0; d < detectors_; ++d) {
        p.plain[d].add(counts(d).first);
        p.difference[d].add(counts(d).first - counts(d).second);
      }
    });
  }

  // A primary of a pixel; `take` gets whether it hit, and per detector the counts and those of its
  // cascade on the plane.
  template <class Take>
  void run(Pixel& p, std::uint64_t electron, std::size_t cascade, const Take& take) {
    check();
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
    take(hit, [&](std::size_t d) {
      return std::pair<int, int>(replay_.detection().counts()[d],
                                 control ? control->counts[d][cascade] : 0);
    });
    replay_.detection().end_primary();
  }

  Estimate control_mean(const Pixel& p, std::size_t d) const {
    if (!p.match.control) return {};
    return estimate(static_cast<std::int64_t>(cascades_), p.match.control->sums[d]);
  }

  // How many primaries bring a detector's standard error down to the target. With n of them and N
  // cascades behind the control's mean the square of the error is, at most (SimulationResult::yield),
  //   v / n + share^2 + 2 sqrt(v / N) share.
  double needed(double variance, double mean, double share) const {
    const double t = wanted_error(options_, mean);
    const double room = t * t - share * share -
                        2 * std::sqrt(variance / static_cast<double>(cascades_)) * share;
    return room > 0 ? variance / room : HUGE_VAL;
  }

  void choose(std::size_t i, UnitTally& out) {
    Pixel& p = sites_[i];
    PixelTally& tally = out.pixels.data()[i];
    if (p.site.single && !p.site.hit) return;
    if (p.plane) {
      tally.model = PixelModel::plane;
      tally.hits = 1;
      return;
    }
    double plain = fewest_primaries, difference = fewest_primaries;
    for (std::size_t d = 0; d < detectors_; ++d) {
      Sample all, left;
      pool(i, d, all, left);
      const double more = all.unseen_variance();
      const double own = p.plain[d].variance();
      const Estimate control = control_mean(p, d);
      plain = std::max(plain, needed(std::max(all.variance(), own) + more, all.mean(), 0));
      if (p.match.control && control.standard_error > most_share * wanted_error(options_, control.mean + left.mean()))
        difference = HUGE_VAL;
      else if (p.match.control)
        difference = std::max(
            difference, needed(std::max(left.variance(), p.difference[d].variance()) + more,
                               control.mean + left.mean(), control.standard_error));
    }
    const bool controlled = p.match.control && difference < plain;
    tally.model = controlled ? PixelModel::difference : PixelModel::replay;
    wanted_[i] = reserve_of_primaries * (controlled ? difference : plain);
  }

  // Pilots of a pixel and its neighbours.
  void pool(std::size_t i, std::size_t d, Sample& all, Sample& left) const {
    for_pilots_near(i, width(), height(), [&](std::size_t k) {
      all += sites_[k].plain[d];
      left += sites_[k].difference[d];
    });
  }

  bool controlled(std::size_t i, const UnitTally& out) const {
    return out.pixels.data()[i].model == PixelModel::difference;
  }

  void serve(UnitTally& out) {
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      Pixel& p = sites_[i];
      const PixelModel model = out.pixels.data()[i].model;
      for (std::size_t d = 0; d < detectors_ && (model == PixelModel::plane || controlled(i, out)); ++d) {
        const Estimate e = control_mean(p, d);
        out.controls[d].data()[i] = {e.mean, e.standard_error, model == PixelModel::plane ? 0.0 : 1.0};
      }
      p.plain.assign(detectors_, {});
      p.difference.assign(detectors_, {});
      if (p.end > 0) p.end += primaries(wanted_[i]);
    }
    for (int round = 0; round < most_rounds; ++round) {
      replay_all([&](std::size_t i, bool hit, const auto& counts) {
        Pixel& p = sites_[i];
        PixelTally& tally = out.pixels.data()[i];
        ++tally.primaries;
        tally.hits += hit ? 1 : 0;
        for (std::size_t d = 0; d < detectors_; ++d) {
          const auto [counted, on_plane] = counts(d);
          const int value = counted - (controlled(i, out) ? on_plane : 0);
          p.plain[d].add(counted);
          p.difference[d].add(value);
          out.counts[d].data()[i].add(value);
        }
      });
      for (std::size_t i = 0; i < sites_.size(); ++i) ask_for_more(i, out);
    }
    for (std::size_t i = 0; i < sites_.size(); ++i)
      for (std::size_t d = 0; d < detectors_; ++d) {
        const Pixel& p = sites_[i];
        if (p.plain[d].variance() > 0)
          out.controls[d].data()[i].variance_left = p.difference[d].variance() / p.plain[d].variance();
      }
  }

  void ask_for_more(std::size_t i, UnitTally& out) {
    Pixel& p = sites_[i];
    if (p.end == 0) return;
    const auto count = p.end - pilot_primaries;
    double more = 0, plain = 0;
    for (std::size_t d = 0; d < detectors_; ++d) {
      const Control& c = out.controls[d].data()[i];
      more = std::max(more, needed(p.difference[d].high_variance(), c.mean + p.difference[d].mean(),
                                   c.standard_error));
      plain = std::max(plain, needed(p.plain[d].high_variance(), p.plain[d].mean(), 0));
    }
    if (more > static_cast<double>(count) && plain < more && controlled(i, out)) {
      give_up_control(i, out);
      more = plain;
    }
    if (more > static_cast<double>(count))
      p.end = pilot_primaries +
              primaries(std::max(1.02 * more, least_growth * static_cast<double>(count)));
  }

  // The same primaries count as they are. Beside steep walls the pilot may promise too much.
  void give_up_control(std::size_t i, UnitTally& out) {
    Pixel& p = sites_[i];
    out.pixels.data()[i].model = PixelModel::replay;
    for (std::size_t d = 0; d < detectors_; ++d) {
      p.difference[d] = p.plain[d];
      out.controls[d].data()[i] = {};
      Counts& counts = out.counts[d].data()[i];
      counts = {};
      counts.sum = std::llround(p.plain[d].sum);
      counts.squares = std::llround(p.plain[d].squares);
    }
  }

  // No more than there are cascades.
  std::uint64_t primaries(double wanted) const {
    return static_cast<std::uint64_t>(std::min(std::ceil(wanted), static_cast<double>(cascades_)));
  }

  const Scene::Impl& scene_;
  const SimulationOptions& options_;
  PlanarControls& controls_;
  SiteReplay replay_;
  std::size_t detectors_;
  std::size_t cascades_;
  WorkUnit unit_;
  std::vector<Pixel> sites_;
  std::vector<double> wanted_;
};

}  // namespace

std::unique_ptr<UnitWorker> make_spending_worker(const Scene::Impl& scene,
                                                 const SimulationOptions& options,
                                                 const Libraries& libraries,
                                                 PlanarControls& controls) {
  return std::make_unique<SpendingWorker>(scene, options, libraries, controls);
}

}  // namespace surf::mc
