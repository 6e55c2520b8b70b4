// SPDX-License-Identifier: GPL-3.0-or-later
// Every operation on scans that takes a Watch tells its progress, ends when asked to, and gives
// what it gives unwatched.
#include "surf/core/progress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "surf/afm/certainty.h"
#include "surf/afm/clean.h"
#include "surf/afm/morphology.h"
#include "surf/afm/substrate_noise.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf {
namespace {

HeightField waves() {
  HeightField f{{}, Grid<double>(60, 50)};
  RandomStream random(3, 0, 0);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 60; ++x)
      f.z_nm(x, y) = std::sin(0.3 * x) + std::cos(0.2 * y) + 0.1 * random.uniform();
  return f;
}

struct Operation {
  std::string name;
  std::function<Grid<double>(const HeightField&, const Watch&)> run;
};

std::ostream& operator<<(std::ostream& out, const Operation& o) { return out << o.name; }

const Tip& tip() {
  static const Tip t = hemisphere_tip(4, 1, 1, 60, 50);
  return t;
}

std::vector<Operation> operations() {
  const auto morphology = [](auto run) {
    return [run](const HeightField& f, const Watch& watch) {
      MorphologyOptions o;
      o.threads = 1;  // of several, the calling one may come to no unit at all
      o.watch = watch;
      return run(f, o).z_nm;
    };
  };
  return {
      {"dilate", morphology([](const HeightField& f, const MorphologyOptions& o) {
         return dilate(f, tip(), o);
       })},
      {"erode", morphology([](const HeightField& f, const MorphologyOptions& o) {
         return erode(f, tip(), o);
       })},
      {"opening", morphology([](const HeightField& f, const MorphologyOptions& o) {
         return opening(f, tip(), o);
       })},
      {"closing", morphology([](const HeightField& f, const MorphologyOptions& o) {
         return closing(f, tip(), o);
       })},
      {"upsampled", morphology([](const HeightField& f, MorphologyOptions o) {
         o.upsample = 2;
         return erode_noncontact(f, tip(), 2, o);
       })},
      {"noncontact", morphology([](const HeightField& f, const MorphologyOptions& o) {
         return dilate_noncontact(f, tip(), 2, o);
       })},
      {"certainty",
       [](const HeightField& f, const Watch& watch) {
         CertaintyOptions o;
         o.threads = 1;
         o.watch = watch;
         return certainty_map(f, tip(), o).surface.z_nm;
       }},
      {"median",
       [](const HeightField& f, const Watch& watch) {
         MedianOptions o;
         o.threads = 1;
         o.watch = watch;
         return median_filter(f, o).field.z_nm;
       }},
      {"flat_closing",
       [](const HeightField& f, const Watch& watch) {
         ClosingOptions o;
         o.threads = 1;
         o.watch = watch;
         return flat_closing(f, o).field.z_nm;
       }},
      {"plane",
       [](const HeightField& f, const Watch& watch) {
         const HoughSummary s = find_plane(f, {.watch = watch});
         return Grid<double>(1, 1, s.plane.height_nm);
       }},
      {"substrate_noise",
       [](const HeightField& f, const Watch& watch) {
         FlatNoiseOptions o;
         o.watch = watch;
         return estimate_substrate_noise(f, o).residual_nm;
       }},
  };
}

class WatchedScan : public testing::TestWithParam<Operation> {};

}  // namespace

TEST_P(WatchedScan, TellsAndGivesTheSame) {
  const HeightField field = waves();
  double last = 0;
  int calls = 0;
  const Grid<double> watched = GetParam().run(field, {[&](double done, double total) {
                                                EXPECT_GT(total, 0);
                                                EXPECT_GE(done / total, last);
                                                EXPECT_LE(done / total, 1 + 1e-12);
                                                last = done / total;
                                                ++calls;
                                              }});
  EXPECT_GT(calls, 1);
  EXPECT_GT(last, 0.5);
  EXPECT_EQ(watched, GetParam().run(field, {}));
}

TEST_P(WatchedScan, EndsWhenAskedTo) {
  const HeightField field = waves();
  CancelToken token;
  // At the first word of progress, so that work has begun.
  const Watch watch{[&](double, double) { token.cancel(); }, &token};
  EXPECT_THROW(GetParam().run(field, watch), Interrupted);
}

INSTANTIATE_TEST_SUITE_P(All, WatchedScan, testing::ValuesIn(operations()),
                         [](const auto& operation) { return operation.param.name; });

}  // namespace surf
