// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/image.h"
#include "surf/core/image_rows.h"
#include "surf/core/large_grid.h"
#include "surf/core/progress.h"
#include "surf/mc/beam.h"
#include "surf/mc/budget.h"
#include "surf/mc/detector.h"
#include "surf/mc/observer.h"
#include "surf/mc/library_source.h"
#include "surf/mc/physics.h"
#include "surf/mc/scene.h"
#include "surf/mc/spectra.h"
#include "surf/mc/tally.h"
#include "surf/mc/unit_journal.h"

namespace surf::mc {

/// How electrons are simulated. Replay retraces stored cascades; both have the same statistics.
enum class Method { direct, replay };

/// How the work is carried out. Nothing of it changes the result.
struct Execution {
  int threads = 0;                ///< 0: one per hardware thread
  int tile_pixels = 1024;         ///< pixels in a unit of work, >= 1
  /// Tallies of more bytes than this (16 per pixel, and 16 per pixel and detector) go into scratch
  /// files in `scratch_folder`; never where that is empty.
  std::size_t tally_memory = std::size_t{1} << 30;
  std::string scratch_folder;
};

void describe(ParameterVisitor& visit, Execution& execution);

struct SimulationOptions : Execution {
  Budget budget;                  ///< no TimeLimit
  Method method = Method::direct;
  bool planar_control = true;     ///< with an accuracy: average the difference to a plane's outcome
  std::uint64_t seed = 1;
  std::vector<Detector> detectors = default_detectors();   ///< at least one; unique names
  bool spectra = false;           ///< collect `Spectra` per detector
  /// With an accuracy, all libraries together grow beyond their least size only up to this many bytes.
  double library_memory = 2.0 * (1u << 30);
};

/// What a primary counts on average on a plane across the beam, of one material in one detector.
struct CascadeYield {
  double mean = 0, variance = 0;
};

/// The part of a wanted variance that a library's own share may take. A pixel takes no cascade twice, and
/// shares the smaller part of its cascades with others: no more than a quarter is common to all. The
/// means on planes are over all of them. (A pilot finds a variance a little low at times.)
inline constexpr double usual_share_of_variance = 0.24;

/// How many cascades of each material replay with these options takes, where no pixel has more than
/// `most_primaries`. With an accuracy (2 / share)^2, the least that any use can be made of, and where `yields` are known as many as
/// it takes for the library's share to be `share` of the variance asked for, 0 to 1.
std::size_t library_size(const SimulationOptions& options, std::int64_t most_primaries,
                         std::span<const CascadeYield> yields = {}, double share = usual_share_of_variance);

/// Bytes of a result's tallies.
std::size_t tally_bytes(const Scan& scan, const SimulationOptions& options);

/// A rectangle of pixels and a range of primaries: the unit of work. Tallies of units merge in any
/// order to the same result.
struct WorkUnit {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;      ///< pixels [x0, x1) x [y0, y1)
  std::int64_t first_electron = 0;
  std::int64_t electrons = 0;
};

struct UnitTally {
  Grid<PixelTally> pixels;               ///< of the unit's rectangle
  std::vector<Grid<Counts>> counts;      ///< per detector
  std::vector<Grid<Control>> controls;   ///< per detector, with `accuracy`
  std::vector<Spectra> spectra;          ///< per detector, where asked for
  Balance balance;
};

/// Simulates one unit of work on the calling thread. With an `observer` every track is followed to
/// its end; without (null), electrons too far from any surface to matter are given up early, as
/// `simulate` does. Both have the same statistics but not the same random numbers.
/// Of the options, seed, dose, detectors and spectra count.
UnitTally simulate_unit(const Scene& scene, const SimulationOptions& options, const WorkUnit& unit,
                        Observer* observer = nullptr);

struct SimulationResult {
  std::vector<Detector> detectors;       ///< as in the options
  LargeGrid<PixelTally> pixels;
  std::vector<LargeGrid<Counts>> counts; ///< per detector
  std::vector<LargeGrid<Control>> controls;   ///< per detector, with `accuracy`
  std::vector<Spectra> spectra;          ///< per detector, where asked for
  Balance balance;
  Budget budget;                         ///< as in the options
  std::uint64_t seed = 1;
  std::size_t library_cascades = 0;      ///< of each material, with replay
  std::vector<CascadeYield> cascade_yields;   ///< with `accuracy`: per material and detector
  double library_seconds = 0;            ///< wall time to get the libraries
  std::int64_t recalled = 0;             ///< primaries among `balance` that a journal knew already
  bool complete = true;          ///< false when cancelled: some pixels have fewer primaries, or none
  double seconds = 0;            ///< wall time of the simulation, scene building and recalled units
                                 ///< apart

  /// Yield of a detector at a pixel, its efficiency included. With a control the standard error
  /// includes the library's own share.
  Estimate yield(std::size_t detector, int x, int y) const;

  /// For loops over many pixels: see `LargeGrid::release`.
  void release() const;
};

/// The observer of each of the simulating threads, asked for once per thread, 0 to the number of
/// threads less one. They must outlive the simulation.
using ObserverOfThread = std::function<Observer*(int thread)>;

class Crew;

/// Who takes part in a simulation, and who watches it. All of it may be left out.
struct SimulationContext {
  ProgressCallback progress;             ///< counts primaries, with an accuracy pixels; told after each unit that is simulated
  const CancelToken* cancel = nullptr;
  ObserverOfThread observers;            ///< every track is then followed to its end, as in `simulate_unit`
  /// Is told of every finished unit and asked for those done before: of the same scene and options, `tile_pixels` among them.
  UnitJournal* journal = nullptr;
  LibrarySource* libraries = nullptr;    ///< where replay gets its cascades; null: they are made on the spot
  Crew* crew = nullptr;                  ///< other processes, all of which call `simulate`

  /// Throws UsageError for what cannot go together.
  void check(const SimulationOptions& options, const Scene& scene) const;
};

/// Simulates the whole scan, in parallel. On cancellation returns what is done. Replay cannot serve observers, nor physics
/// without continuous loss; observers go with neither a journal nor a crew nor an accuracy (UsageError). With a crew the
/// result is the leader's, others return one that counts nothing and is complete; only the leader's journal is used. Bytes
/// are the same with and without.
SimulationResult simulate(const Scene& scene, const SimulationOptions& options, const SimulationContext& context = {});

/// Per detector the channels NAME and NAME.stderr, in counts per primary; with a dose also
/// NAME.shot, what a microscope would show: electrons counted over the mean number of primaries.
/// Then valid: 1 where the beam meets the specimen and at least one primary was simulated. Placed in
/// the scan plane.
Image make_image(const SimulationResult& result, const Scan& scan);

/// The same, row by row. Refers to `result`.
ImageRows make_image_rows(const SimulationResult& result, const Scan& scan);

}  // namespace surf::mc
