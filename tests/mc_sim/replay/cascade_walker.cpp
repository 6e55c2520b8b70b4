// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/cascade_walker.h"

#include <gtest/gtest.h>

#include "cascades/walk_cascade.h"
#include "surf/io/sim/materials.h"

namespace surf::mc {
namespace {

constexpr double beam_ev = 800;

const CascadeLibrary& library() {
  static const CascadeLibrary all = [] {
    const Material silicon = io::find_material("Si", "test");
    CascadeLibrary made({silicon, {}, beam_ev + silicon.barrier_ev, 3});
    made.grow(CascadeLibrary::page_cascades, 1);
    return made;
  }();
  return all;
}

ReplayMaterial material() {
  const Medium& medium = library().medium();
  return {&library(), &medium, medium.barrier_ev(), medium.loses_in_events(),
          EnergyCode(medium.cutoff_ev(), library().settings().start_energy_ev)};
}

/// Passes what it is told to, and ends the track whose segment of this number comes.
struct Handler {
  using State = int;
  bool passes_all = false;
  std::int64_t gone_at = -1;
  std::int64_t segments = 0, asked = 0;
  std::vector<double> energies;  // at the beginning of segments
  Balance balance;
  Ledger books{balance};
  ReplayMaterial only = material();

  const ReplayMaterial& medium(int) const { return only; }
  Ledger& ledger() { return books; }
  bool passes(Branch<int>&, std::uint64_t, Near&) {
    ++asked;
    return passes_all;
  }
  unsigned passed(const Branch<int>&, const std::uint64_t*, int, const Near&) { return 0; }
  unsigned eventful(const NodeView& node, const Branch<int>&, const Near&) {
    return (1u << node.node.count) - 1;
  }
  Moved meets(const WalkedSegment& s, Branch<int>&, const Near&) {
    energies.push_back(s.inside ? s.inside->energy_ev : only.energy_ev(s.view, s.number));
    return segments++ == gone_at ? Moved::gone : Moved::no;
  }
  bool scattered(const WalkedSegment&, Moved, Branch<int>&, Near&) { return false; }
};
static_assert(WalkHandler<Handler>);

/// What the whole cascade holds, by another reader.
struct Count {
  std::int64_t segments = 0, electrons = 0;
  double total_ev = 0;
  void segment(const CascadeSegment& s) {
    ++segments;
    if (s.first && !s.primary) total_ev += s.energy_from_ev;
  }
  void stop(const Vec3&, bool) { ++electrons; }
};

void walk(Handler& handler, std::size_t cascade, const StartInside* inside = nullptr) {
  const std::uint64_t* root = library().cascade(cascade).data();
  handler.books.begin(beam_ev);
  handler.books.add(NodeView(root).node);
  if (inside) handler.books.take_off(NodeView(root).node);
  Branch<int> branch;
  CascadeWalker<Handler>(handler).follow(root, branch, {}, inside);
  handler.books.end(true);
}

TEST(CascadeWalker, ComesToEverySegmentAndCountsEverySecondary) {
  for (std::size_t cascade = 0; cascade < 50; ++cascade) {
    Count all;
    const EnergyCode code = material().code;
    CascadeWalk<Count>(code, all).walk(library().cascade(cascade).data());
    Handler handler;
    walk(handler, cascade);
    EXPECT_EQ(handler.segments, all.segments);
    EXPECT_EQ(handler.balance.generated, all.electrons - 1);
    EXPECT_NEAR(handler.balance.generated_energy.ev(),
                all.total_ev - double(all.electrons - 1) * material().barrier_ev,
                1e-3 * all.total_ev + 1e-6);
  }
}

TEST(CascadeWalker, LeavesOutWhatIsPassedButCountsIt) {
  for (std::size_t cascade = 0; cascade < 50; ++cascade) {
    Handler whole, passing;
    passing.passes_all = true;
    walk(whole, cascade);
    walk(passing, cascade);
    EXPECT_LE(passing.segments, segments_per_node);
    EXPECT_EQ(passing.balance.generated, whole.balance.generated);
  }
}

TEST(CascadeWalker, TakesOffWhatAnElectronThatIsGoneDoesNotGenerate) {
  for (std::size_t cascade = 0; cascade < 50; ++cascade) {
    Handler whole, gone;
    gone.gone_at = 0;
    walk(whole, cascade);
    walk(gone, cascade);
    EXPECT_EQ(gone.segments, 1);
    EXPECT_EQ(gone.balance.generated, 0);
    EXPECT_NEAR(gone.balance.generated_energy.ev(), 0, 2e-5 * beam_ev);  // nodes keep floats
    // In the midst of it: more than none, fewer than all.
    Handler later;
    later.gone_at = whole.segments / 2;
    walk(later, cascade);
    EXPECT_LE(later.balance.generated, whole.balance.generated);
    EXPECT_GT(later.segments, later.gone_at);
  }
}

TEST(CascadeWalker, BeginsInsideWhereTheEnergyFallsToWhatIsAsked) {
  for (std::size_t cascade = 0; cascade < 50; ++cascade) {
    const StartInside inside{beam_ev / 2, {}};
    Handler handler, whole;
    walk(handler, cascade, &inside);
    walk(whole, cascade);
    ASSERT_FALSE(handler.energies.empty());
    EXPECT_EQ(handler.energies.front(), inside.energy_ev);
    EXPECT_LT(handler.segments, whole.segments);
    EXPECT_LE(handler.balance.generated, whole.balance.generated);
  }
}

}  // namespace
}  // namespace surf::mc
