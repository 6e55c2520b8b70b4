// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "surf/core/progress.h"
#include "surf/mc/results/unit_tally.h"
#include "surf/mc/transport/observer.h"

namespace surf::mc {

/// Primaries of one pixel, by number: from `first` to before `end`.
struct PrimaryRange {
  std::uint64_t first = 0, end = 0;
};

/// The pixels that a source is to serve next.
struct SourceTask {
  const WorkUnit& unit;
  std::span<const std::int64_t> expected =
      {};                        ///< primaries of each pixel, row by row; empty: many
  Observer* observer = nullptr;  ///< may be null; replay has nothing to show it
  const CancelToken* cancel =
      nullptr;  ///< looked at with each primary: a unit takes seconds where electrons are fast
};

/// Stands in for a visitor in the concept below.
struct VisitNothing {
  void operator()(std::size_t, std::uint64_t, bool, const auto&) const {}
};

/// Where the outcome of a primary comes from: it is simulated, or it is a stored cascade that is
/// replayed. A source serves one thread. Pixels are numbered row by row within the unit.
///
///   model                        what the pixels of its primaries are called
///   misses_are_known             `misses` finds all pixels that the beam misses, before any
///   primary is simulated begin(task)                  looks at the pixels of a unit serve(ranges,
///   visit)         simulates the primaries of `ranges`, one range for each pixel, in an order of
///   its own:
///                                visit(pixel, number, hit, counts), where counts(detector) gives
///                                the electrons of the primary and those of its control (0
///                                without). Throws Interrupted
///   finish(tally)                adds balance and spectra of all primaries since `begin`
///   most_primaries()             of a pixel, where an accuracy is wanted
///   misses(pixel)                the beam meets nothing there
///   settled(pixel)               the control is the result: there is nothing left to simulate
///   controlled(pixel)            there is a control
///   control(pixel, detector)     its mean and the standard error of that, from `most_primaries()`
///   primaries
template <class S>
concept PrimarySource = requires(S source, const S& known, const SourceTask& task,
                                 std::span<const PrimaryRange> ranges, UnitTally& tally,
                                 std::size_t number) {
  { S::model } -> std::convertible_to<PixelModel>;
  { S::misses_are_known } -> std::convertible_to<bool>;
  source.begin(task);
  source.serve(ranges, VisitNothing{});
  source.finish(tally);
  { known.most_primaries() } -> std::same_as<std::uint64_t>;
  { known.misses(number) } -> std::same_as<bool>;
  { known.settled(number) } -> std::same_as<bool>;
  { known.controlled(number) } -> std::same_as<bool>;
  { known.control(number, number) } -> std::same_as<Estimate>;
};

}  // namespace surf::mc
