// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/ledger.h"

#include <gtest/gtest.h>

namespace surf::mc {
namespace {

PackedNode node(std::uint32_t generated, float total_ev) {
  PackedNode out{};
  out.generated = generated;
  out.generated_ev = total_ev;
  return out;
}

TEST(Ledger, EveryElectronIsCountedOnce) {
  Balance b;
  Ledger ledger(b);
  ledger.begin(1000);
  ledger.add(node(7, 70));
  ledger.take_off(node(2, 20));  // of nodes that an electron that is gone did not reach
  ledger.add(5.0);
  ledger.take_off(5.0);
  ledger.escape(12);
  ledger.lose(LossCause::wrong_side, 3);
  ledger.hand_over(40);
  ledger.end(true);
  EXPECT_EQ(b.incident, 1);
  EXPECT_EQ(b.missed, 0);
  EXPECT_EQ(b.generated, 5);
  EXPECT_EQ(b.handed_over, 1);
  EXPECT_EQ(b.total_lost(), 1);
  EXPECT_EQ(b.absorbed, 1 + 5 - 3);
  EXPECT_DOUBLE_EQ(b.generated_energy.ev(), 50);
  EXPECT_DOUBLE_EQ(b.escaped_energy.ev(), 12);
  EXPECT_DOUBLE_EQ(b.lost_energy.ev(), 3);
  // What was handed over is in the books of direct simulation.
  EXPECT_DOUBLE_EQ(b.deposited_energy.ev(), 1000 + 50 - 12 - 3 - 40);
}

TEST(Ledger, BeginsAnewWithEachPrimary) {
  Balance b;
  Ledger ledger(b);
  ledger.begin(500);
  ledger.add(node(3, 30));
  ledger.end(true);
  ledger.begin(500);
  ledger.end(false);
  EXPECT_EQ(b.incident, 2);
  EXPECT_EQ(b.missed, 1);
  EXPECT_EQ(b.generated, 3);
  EXPECT_EQ(b.absorbed, 5);
}

}  // namespace
}  // namespace surf::mc
