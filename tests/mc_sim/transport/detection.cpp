// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/detection.h"

#include <cmath>
#include <vector>

#include "specimens.h"
#include "statistics.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

SimulationResult run(const std::vector<std::string>& wanted, double tilt_deg,
                     std::int64_t electrons = 400, bool spectra = false) {
  SimulationOptions options;
  options.budget = ElectronsPerPixel{electrons};
  options.spectra = spectra;
  for (const std::string& text : wanted)
    for (const Detector& d : parse_detectors(text, "test")) options.detectors.push_back(d);
  Specimen specimen = test::flat("Si");
  specimen.bodies.push_back({"box", make_box({-20, -20, 0}, {20, 20, 30}), 0});
  Beam beam;
  beam.tilt_deg = tilt_deg;
  beam.azimuth_deg = 30;
  return simulate(Scene(specimen, beam, test::square_scan(60, 5)), options);
}

// Whether detectors [first, last) of a result count each electron of `whole` once.
void expect_partition(const SimulationResult& r, std::size_t whole, std::size_t first,
                      std::size_t last) {
  for (std::size_t i = 0; i < r.pixels.size(); ++i) {
    std::int64_t sum = 0;
    for (std::size_t d = first; d < last; ++d) sum += r.counts[d].data()[i].sum;
    EXPECT_EQ(sum, r.counts[whole].data()[i].sum);
  }
}

std::int64_t total(const SimulationResult& r, std::size_t detector) {
  std::int64_t sum = 0;
  for (const Counts& c : r.counts[detector].data()) sum += c.sum;
  return sum;
}

}  // namespace

TEST(Detection, QuadrantsAndWindowsAndConesPartitionTheTotal) {
  for (const double tilt : {0.0, 50.0}) {
    const auto r = run(
        {"quadrants", "a:energy=50..300,side=up", "b:energy=300..700,side=up",
         "c:energy=700..,side=up", "k:energy=50..,side=up,cone=0..20",
         "l:energy=50..,side=up,cone=20..60", "m:energy=50..,side=up,cone=60..180", "SE1", "SE2"},
        tilt);
    expect_partition(r, test::bse, 2, 6);
    expect_partition(r, test::bse, 6, 9);
    expect_partition(r, test::bse, 9, 12);
    expect_partition(r, test::se, 12, 14);
    for (std::size_t d = 0; d < r.counts.size(); ++d) EXPECT_GT(total(r, d), 50) << d;
    EXPECT_EQ(total(r, test::bse), r.balance.bse);
    EXPECT_EQ(total(r, test::se), r.balance.se);
  }
}

TEST(Detection, SectorsLieAsTheyAreNamed) {
  const std::vector<Vec3> directions{
      {0.6, 0.1, 0.79}, {-0.1, 0.6, 0.79}, {-0.6, 0, 0.8}, {0.1, -0.6, 0.79}};
  for (std::size_t i = 0; i < 4; ++i) {
    Detection one(parse_detectors("quadrants", "test"), {}, false);
    one.escaped({100, normalized(directions[i]), false, false});
    for (std::size_t d = 0; d < 4; ++d) EXPECT_EQ(one.counts()[d], i == d ? 1 : 0);
  }
}

TEST(Detection, ConesAreAboutTheBeamOrAboutTheirOwnAxis) {
  Beam beam;
  beam.tilt_deg = 40;
  const Vec3 back = -direction(beam);
  Detection d(parse_detectors("x:cone=10", "test"), beam, false);
  d.escaped({100, back, false, false});
  d.escaped({100, {0, 0, 1}, false, false});
  EXPECT_EQ(d.counts()[0], 1);
  Detection up(parse_detectors("x:cone=10,axis=0deg", "test"), beam, false);
  up.escaped({100, back, false, false});
  up.escaped({100, {0, 0, 1}, false, false});
  EXPECT_EQ(up.counts()[0], 1);
  Detection side(parse_detectors("side", "test"), beam, false);
  side.escaped({10, normalized({1, 0, 0.1}), true, false});
  side.escaped({10, normalized({-1, 0, 0.1}), true, false});
  side.escaped({60, normalized({1, 0, 0.1}), true, false});
  EXPECT_EQ(side.counts()[0], 1);
}

TEST(Detection, EfficiencyScalesYieldAndError) {
  const auto r = run({"half:energy=..50eV,efficiency=50%"}, 0);
  for (int x = 0; x < 5; ++x) {
    EXPECT_DOUBLE_EQ(r.yield(2, x, 2).mean, 0.5 * r.yield(test::se, x, 2).mean);
    EXPECT_DOUBLE_EQ(r.yield(2, x, 2).standard_error, 0.5 * r.yield(test::se, x, 2).standard_error);
  }
}

TEST(Spectra, AddUpToTheCountsForAnyThreads) {
  const auto r = run({"quadrants"}, 30, 300, true);
  ASSERT_EQ(r.spectra.size(), 6u);
  for (std::size_t d = 0; d < 6; ++d) {
    for (const Histogram* h :
         {&r.spectra[d].energy_ev, &r.spectra[d].polar_deg, &r.spectra[d].azimuth_deg}) {
      std::int64_t sum = 0;
      for (const Counts& c : h->bins) {
        sum += c.sum;
        EXPECT_GE(c.squares, c.sum);
      }
      EXPECT_EQ(sum, total(r, d));
    }
  }
  // The left quadrant's azimuths lie between 135 and 225 degrees about the beam.
  const auto straight = run({"quadrants"}, 0, 300, true);
  const Histogram& left = straight.spectra[4].azimuth_deg;
  for (std::size_t i = 0; i < left.bins.size(); ++i)
    if (left.edge(i) < 135 || left.edge(i) >= 225) {
      EXPECT_EQ(left.bins[i].sum, 0) << left.edge(i);
    }
}

namespace {

// Tells SE1 from SE2 by what an observer sees: where along the primary's path a cascade starts.
class Chronicle final : public Observer {
 public:
  void primary(std::int64_t, std::int64_t) override {
    path_.clear();
    turned_.clear();
  }
  void begin_track(int track, int parent, int generation, const Vec3& at, const Vec3&,
                   double) override {
    bool turned = false;
    if (generation == 1) {
      for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
        turned = turned || path_[i + 1].z > path_[i].z;
        if (path_[i + 1] == at) break;
      }
    } else if (generation > 1) {
      turned = turned_.at(static_cast<std::size_t>(parent));
    }
    turned_.resize(static_cast<std::size_t>(track) + 1);
    turned_[static_cast<std::size_t>(track)] = turned;
    current_ = track;
  }
  void segment(const Vec3& from, const Vec3& to, double, double, int) override {
    if (current_ != 0) return;
    if (path_.empty()) path_.push_back(from);
    path_.push_back(to);
  }
  void end_track(TrackKind end, const Vec3&, const Vec3&, double) override {
    if (end != TrackKind::se) return;
    const bool turned = current_ == 0 || turned_[static_cast<std::size_t>(current_)];
    ++(turned ? se2 : se1);
  }
  std::int64_t se1 = 0, se2 = 0;

 private:
  std::vector<Vec3> path_;
  std::vector<bool> turned_;
  int current_ = 0;
};

}  // namespace

TEST(Detection, Se1IsWhatStartsBeforeThePrimaryTurns) {
  SimulationOptions options;
  options.detectors = parse_detectors("SE1", "test");
  options.detectors.push_back(parse_detectors("SE2", "test")[0]);
  const Scene scene(test::flat("Si"), {}, test::square_scan(10, 1));
  Chronicle chronicle;
  const UnitTally r = simulate_unit(scene, options, {0, 0, 1, 1, 0, 4000}, &chronicle);
  EXPECT_GT(chronicle.se1, 500);
  EXPECT_GT(chronicle.se2, 200);
  // A direction exactly level may fall either way.
  EXPECT_NEAR(static_cast<double>(r.counts[0](0, 0).sum), static_cast<double>(chronicle.se1), 3);
  EXPECT_NEAR(static_cast<double>(r.counts[1](0, 0).sum), static_cast<double>(chronicle.se2), 3);
}

}  // namespace surf::mc
