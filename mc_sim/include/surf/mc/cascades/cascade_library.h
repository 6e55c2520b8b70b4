// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "surf/core/progress.h"
#include "surf/mc/cascades/cascade_key.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/physics/physics.h"

namespace surf::mc {

/// Cascades packed one after the other (mc_sim/src/cascade_format.h); cascade i starts at word
/// `starts[i]` and ends where the next begins, at `starts[i + 1]`.
struct CascadePage {
  std::vector<std::uint64_t> words;
  std::vector<std::uint32_t> starts;  ///< one more than there are cascades
};

/// What a library's cascades depend on. Cascade number k is a pure function of these and k.
struct CascadeSettings {
  Material material;
  Physics physics;             ///< `barrier` matters for what energies count from
  double start_energy_ev = 0;  ///< of the primaries inside: above the bottom of the band
  std::uint64_t seed = 1;
};

/// Electron cascades in an endless medium: a primary that starts at the origin along -z, with all
/// its secondaries, each followed to the cutoff (thesis, 5.2.2.1). Positions are kept to 2^-16 of
/// the extent of each electron with what it generates, energies to about 1e-3 eV near the cutoff.
/// It grows page by page; a page depends on its number alone.
class CascadeLibrary {
 public:
  static constexpr std::size_t page_cascades = 2048;

  explicit CascadeLibrary(CascadeSettings settings);

  const CascadeSettings& settings() const { return settings_; }
  const Medium& medium() const { return *medium_; }
  std::size_t pages() const { return pages_.size(); }
  const CascadePage& page(std::size_t number) const { return *pages_.at(number); }
  std::size_t cascades() const { return pages_.size() * page_cascades; }
  std::size_t bytes() const;

  /// A page made from scratch, on `threads` threads (0: one per hardware thread). The watch counts
  /// the page's cascades. Throws Interrupted.
  CascadePage make_page(std::size_t number, int threads, const Watch& watch = {}) const;

  /// Takes the next page. Throws InvalidInput where it is not a page: one that is can be replayed
  /// safely, wherever it comes from.
  void add_page(std::shared_ptr<const CascadePage> page);

  /// Whether page `number` would begin like this if it were made now: its first cascades, at least
  /// `sample_bytes` of them, are made again and compared word for word. A page that another version
  /// of semsurf or another kind of processor has made differs here.
  bool would_make(const CascadePage& page, std::size_t number,
                  std::size_t sample_bytes = std::size_t{1} << 15) const;

  /// The same library with its first `pages` pages alone; they are shared, not copied.
  CascadeLibrary first(std::size_t pages) const;

  /// Makes pages until there are at least `cascades`. The watch counts cascades. Throws
  /// Interrupted; the pages that were finished before stay.
  void grow(std::size_t cascades, int threads, const Watch& watch = {});

  /// Has the beginning of a cascade fetched from memory: it will be asked for soon.
  void fetch(std::size_t number) const {
    constexpr std::size_t line_words = 8, lines = 40;
    const std::span<const std::uint64_t> words = cascade(number);
    const std::size_t end = words.size() < lines * line_words ? words.size() : lines * line_words;
    for (std::size_t i = 0; i < end; i += line_words) __builtin_prefetch(words.data() + i);
  }

  /// How far from their start cascades get: with continuous loss, what no cascade exceeds; else the
  /// farthest of those that there are.
  double reach_nm() const;

  /// The words of a cascade, number < cascades().
  std::span<const std::uint64_t> cascade(std::size_t number) const {
    const CascadePage& page = *pages_[number / page_cascades];
    const std::size_t i = number % page_cascades;
    return {page.words.data() + page.starts[i], page.words.data() + page.starts[i + 1]};
  }

 private:
  CascadeSettings settings_;
  std::shared_ptr<const Medium> medium_;
  std::vector<std::shared_ptr<const CascadePage>> pages_;
  std::vector<double> reaches_nm_;  // of the cascades of each page
};

/// Whether cascades in this medium can be turned and mirrored, and gone on with where an electron
/// comes back into it with the energy that it left with: energy falls by continuous loss alone, or
/// in events alone. Where electrons enter with any other energy, only continuous loss lets them
/// join a cascade; else they are followed directly.
bool can_replay(const Medium& medium);
/// Whether it can in one at least of these: in the others electrons are followed directly.
bool can_replay(const Physics& physics, std::span<const Material> materials);

/// What is in a library, over its first `cascades` cascades (all, if fewer).
struct CascadeStatistics {
  std::size_t cascades = 0;
  double bytes_per_cascade = 0;
  double segments_per_cascade = 0;
  double electrons_per_cascade = 0;      ///< the primary and its secondaries
  std::vector<double> primary_depth_nm;  ///< per cascade: the deepest point of the primary
  std::vector<double>
      primary_extent_nm;  ///< per cascade: the primary's greatest distance from its start
};
CascadeStatistics describe(const CascadeLibrary& library, std::size_t cascades);

}  // namespace surf::mc
