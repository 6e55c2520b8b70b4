// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "sampling/adaptive_sampling.h"
#include "sampling/primary_source.h"
#include "sampling/unit_worker.h"

namespace surf::mc {

/// Serves each pixel until a wanted accuracy is reached. A pilot tells how much the counts scatter,
/// by themselves and as differences to their control; then the number of primaries is set, and
/// fresh ones are counted. The pilot's are not: who stops when the dice were good, or goes on
/// because they were bad, gets the mean wrong.
template <PrimarySource Source>
class AdaptiveSampler final : public UnitWorker {
 public:
  template <class... Arguments>
  AdaptiveSampler(const Scene::Impl& scene, const SimulationOptions& options,
                  const Arguments&... arguments)
      : options_(options), detectors_(options.detectors.size()),
        source_(scene, options, arguments...) {}

  /// Nobody observes: what is seen of a pilot would not count.
  void simulate(const WorkUnit& unit, Observer*, UnitTally& out) override {
    clear(out, unit, detectors_);
    out.controls.assign(detectors_, Grid<Control>(unit.x1 - unit.x0, unit.y1 - unit.y0));
    source_.begin({.unit = unit, .cancel = cancel});
    pixels_.assign(out.pixels.size(), Pixel(detectors_));
    ranges_.assign(out.pixels.size(), {});
    run_pilots();
    std::vector<double> wanted(pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i) wanted[i] = choose(i, out);
    for (std::size_t i = 0; i < pixels_.size(); ++i) begin_counting(i, wanted[i], out);
    for (int round = 0; round <= most_rounds && is_anything_open(); ++round) {
      count(out);
      for (std::size_t i = 0; i < pixels_.size(); ++i) ask_for_more(i, out);
    }
    for (std::size_t i = 0; i < pixels_.size(); ++i) conclude(i, out);
    source_.finish(out);
  }

 private:
  // A control's error takes no more of the target. Beside steep walls it would, and the difference
  // could not make up for it.
  static constexpr double most_share = 0.9;

  struct Pixel {
    explicit Pixel(std::size_t detectors) : plain(detectors), difference(detectors) {}

    bool is_open = false;                   // primaries are to be counted
    bool hit = false;                       // any primary of the pilot
    std::vector<Sample> plain, difference;  // the pilot's, then those that count; per detector
  };

  void run_pilots() {
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      pixels_[i].is_open = !source_.misses(i) && !source_.settled(i);
      if (pixels_[i].is_open) ranges_[i].end = pilot_primaries;
    }
    source_.serve(ranges_, [&](std::size_t i, std::uint64_t, bool hit, const auto& counts) {
      Pixel& p = pixels_[i];
      p.hit |= hit;
      for (std::size_t d = 0; d < detectors_; ++d) {
        const auto [counted, of_control] = counts(d);
        p.plain[d].add(counted);
        p.difference[d].add(counted - of_control);
      }
    });
  }

  // How many primaries bring a detector's standard error down to the target. With n of them and N
  // primaries behind the control's mean the square of the error is, at most
  // (SimulationResult::yield),
  //   v / n + share^2 + 2 sqrt(v / N) share.
  double needed(double variance, double mean, double share) const {
    const double t = wanted_error(options_, mean);
    const double behind = static_cast<double>(source_.most_primaries());
    const double room = t * t - share * share - 2 * std::sqrt(variance / behind) * share;
    return room > 0 ? variance / room : HUGE_VAL;
  }

  // Sets the pixel's model, and returns how many primaries it needs.
  double choose(std::size_t i, UnitTally& out) const {
    PixelTally& tally = out.pixels.data()[i];
    if (source_.misses(i)) return 0;
    if (source_.settled(i)) {
      tally.model = PixelModel::plane;
      tally.hits = 1;
      return 0;
    }
    tally.model = Source::model;
    // As far as can be told, the beam misses everything.
    if (!Source::misses_are_known && !pixels_[i].hit) return fewest_primaries;
    const bool controlled = source_.controlled(i);
    double plain = fewest_primaries, difference = fewest_primaries;
    for (std::size_t d = 0; d < detectors_; ++d) {
      Sample all, left;
      for_pilots_near(i, out.pixels.width(), out.pixels.height(), [&](std::size_t k) {
        all += pixels_[k].plain[d];
        left += pixels_[k].difference[d];
      });
      const double more = all.unseen_variance();
      plain = std::max(
          plain,
          needed(std::max(all.variance(), pixels_[i].plain[d].variance()) + more, all.mean(), 0));
      if (!controlled) continue;
      const Estimate control = source_.control(i, d);
      const double mean = control.mean + left.mean();
      if (control.standard_error > most_share * wanted_error(options_, mean)) difference = HUGE_VAL;
      else
        difference =
            std::max(difference,
                     needed(std::max(left.variance(), pixels_[i].difference[d].variance()) + more,
                            mean, control.standard_error));
    }
    const bool by_difference = controlled && difference < plain;
    if (by_difference) tally.model = PixelModel::difference;
    return reserve_of_primaries * (by_difference ? difference : plain);
  }

  void begin_counting(std::size_t i, double wanted, UnitTally& out) {
    Pixel& p = pixels_[i];
    const PixelModel model = out.pixels.data()[i].model;
    if (model == PixelModel::plane || model == PixelModel::difference)
      for (std::size_t d = 0; d < detectors_; ++d) {
        const Estimate e = source_.control(i, d);
        out.controls[d].data()[i] = {e.mean, e.standard_error,
                                     model == PixelModel::plane ? 0.0 : 1.0};
      }
    p.plain.assign(detectors_, {});
    p.difference.assign(detectors_, {});
    if (p.is_open) ranges_[i] = {pilot_primaries, pilot_primaries + allowed(wanted)};
  }

  std::uint64_t allowed(double primaries) const {
    return static_cast<std::uint64_t>(
        std::min(std::ceil(primaries), static_cast<double>(source_.most_primaries())));
  }

  bool is_anything_open() const {
    return std::ranges::any_of(ranges_, [](const PrimaryRange& r) { return r.first < r.end; });
  }

  void count(UnitTally& out) {
    source_.serve(ranges_, [&](std::size_t i, std::uint64_t, bool hit, const auto& counts) {
      Pixel& p = pixels_[i];
      PixelTally& tally = out.pixels.data()[i];
      ++tally.primaries;
      tally.hits += hit ? 1 : 0;
      for (std::size_t d = 0; d < detectors_; ++d) {
        const auto [counted, of_control] = counts(d);
        const int value = counted - (tally.model == PixelModel::difference ? of_control : 0);
        p.plain[d].add(counted);
        p.difference[d].add(value);
        out.counts[d].data()[i].add(value);
      }
    });
    for (PrimaryRange& r : ranges_) r.first = std::max(r.first, r.end);
  }

  void ask_for_more(std::size_t i, UnitTally& out) {
    Pixel& p = pixels_[i];
    if (!p.is_open) return;
    const auto counted = static_cast<double>(out.pixels.data()[i].primaries);
    double more = 0, plain = 0;
    for (std::size_t d = 0; d < detectors_; ++d) {
      const Control& c = out.controls[d].data()[i];
      more = std::max(more, needed(p.difference[d].high_variance(), c.mean + p.difference[d].mean(),
                                   c.standard_error));
      plain = std::max(plain, needed(p.plain[d].high_variance(), p.plain[d].mean(), 0));
    }
    if (more > counted && plain < more && out.pixels.data()[i].model == PixelModel::difference) {
      give_up_control(i, out);
      more = plain;
    }
    if (more > counted)
      ranges_[i].end = pilot_primaries + allowed(std::max(1.02 * more, least_growth * counted));
  }

  // The same primaries count as they are. Beside steep walls the pilot may promise too much.
  void give_up_control(std::size_t i, UnitTally& out) {
    Pixel& p = pixels_[i];
    out.pixels.data()[i].model = Source::model;
    for (std::size_t d = 0; d < detectors_; ++d) {
      p.difference[d] = p.plain[d];
      out.controls[d].data()[i] = {};
      Counts& counts = out.counts[d].data()[i];
      counts = {};
      counts.sum = std::llround(p.plain[d].sum);
      counts.squares = std::llround(p.plain[d].squares);
    }
  }

  void conclude(std::size_t i, UnitTally& out) const {
    const Pixel& p = pixels_[i];
    PixelTally& tally = out.pixels.data()[i];
    if (!Source::misses_are_known && tally.hits == 0) tally.model = PixelModel::none;
    for (std::size_t d = 0; d < detectors_; ++d)
      if (p.plain[d].variance() > 0)
        out.controls[d].data()[i].variance_left =
            p.difference[d].variance() / p.plain[d].variance();
  }

  const SimulationOptions& options_;
  std::size_t detectors_;
  Source source_;
  std::vector<Pixel> pixels_;
  std::vector<PrimaryRange> ranges_;
};

}  // namespace surf::mc
