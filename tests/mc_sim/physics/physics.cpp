// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/physics.h"

#include "physics/mechanism_test.h"
#include "surf/core/error.h"

namespace surf::mc {

using testing::Contains;
using testing::HasSubstr;

TEST(Physics, ReadsWhatItWrites) {
  Physics p;
  parse_physics("elastic=browning,barrier=off,secondaries=off,loss=none", p);
  EXPECT_EQ(p.elastic, ElasticModel::browning);
  EXPECT_EQ(p.barrier, BarrierModel::off);
  EXPECT_FALSE(p.secondaries);
  EXPECT_EQ(p.loss, LossModel::none);
  Physics q;
  parse_physics(format_physics(p), q);
  EXPECT_EQ(format_physics(q), format_physics(p));
  parse_physics("secondaries=on", p);
  EXPECT_EQ(p.elastic, ElasticModel::browning) << "keys that are not named stay";
}

TEST(Physics, RefusesUnknownWords) {
  Physics p;
  EXPECT_THROW(parse_physics("elastc=mott", p), UsageError);
  EXPECT_THROW(parse_physics("elastic", p), UsageError);
  try {
    parse_physics("elastic=moot", p);
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_THAT(e.what(), HasSubstr("moot"));
    EXPECT_THAT(e.what(), HasSubstr("mott, mott-phonon, browning"));
  }
}

// What is usual with a tier comes with it, wherever in the text it stands; what is said too goes
// before that.
TEST(Physics, ATierBringsWhatIsUsualWithIt) {
  Physics p;
  parse_physics("atoms=free,inelastic=dielectric", p);
  EXPECT_EQ(p.inelastic, InelasticTier::dielectric);
  EXPECT_EQ(p.elastic, ElasticModel::mott_phonon);
  EXPECT_EQ(p.atoms, MottAtoms::free);
  EXPECT_EQ(format_physics(p),
            "inelastic=dielectric,inelastic-model=full-penn,auger=off,elastic=mott-phonon,atoms="
            "free,secondaries=on,barrier=quantum");
  Physics again;
  parse_physics(format_physics(p), again);
  EXPECT_EQ(format_physics(again), format_physics(p));
  parse_physics("elastic=browning", p);
  parse_physics("inelastic=dielectric", p);
  EXPECT_EQ(p.elastic, ElasticModel::browning) << "nothing changes, so nothing comes with it";
  parse_physics("inelastic=monsel", p);
  EXPECT_EQ(p.elastic, ElasticModel::mott);
}

TEST(Physics, RefusesToCountDielectricEnergiesFromTheVacuum) {
  Physics p;
  parse_physics("inelastic=dielectric,barrier=off", p);
  EXPECT_THROW(validate(p), UsageError);
}

// The tiers count energies from different bands: in silicon from the conduction band, and from the
// valence band.
TEST(Physics, CountsFromTheBandOfItsTier) {
  const Material& si = material("Si");
  Physics p;
  EXPECT_EQ(effective_barrier_ev(p, si), si.barrier_ev);
  parse_physics("inelastic=dielectric", p);
  EXPECT_DOUBLE_EQ(effective_barrier_ev(p, si), 7.27 + 1.12 + 4.05);
  EXPECT_EQ(effective_cutoff_ev(p, si), effective_barrier_ev(p, si));
  p.secondaries = false;
  EXPECT_EQ(effective_cutoff_ev(p, si), effective_barrier_ev(p, si) + 50);
}

TEST(Physics, StopsTrackingWhereItSays) {
  const Material& si = material("Si");
  EXPECT_EQ(effective_cutoff_ev({}, si), si.barrier_ev);
  Physics p;
  p.secondaries = false;
  EXPECT_EQ(effective_cutoff_ev(p, si), 50);
  p.cutoff_ev = 20;
  EXPECT_EQ(effective_cutoff_ev(p, si), 20);
}

TEST(Physics, RefusesACutoffThatLeavesNothingToTrack) {
  Physics p;
  for (const double good : {0.0, 0.5, 50.0, 999.0}) {
    p.cutoff_ev = good;
    EXPECT_NO_THROW(validate(p, 1000)) << good;
  }
  for (const double bad : {-5.0, 0.4, 1000.0, 5000.0, 1e300, double(INFINITY), double(NAN)}) {
    p.cutoff_ev = bad;
    EXPECT_THROW(validate(p, 1000), UsageError) << bad;
  }
  for (const double bad : {-5.0, 0.4, double(INFINITY), double(NAN)}) {  // for a beam of any energy
    p.cutoff_ev = bad;
    EXPECT_THROW(make_medium(material("Si"), p), UsageError) << bad;
  }
}

TEST(Physics, DescribesEveryMechanismWithItsSource) {
  const auto lines = describe({}, material("Si"));
  EXPECT_THAT(lines, Contains(HasSubstr("ELSEPA")));
  EXPECT_THAT(lines, Contains(HasSubstr("Moeller")));
  EXPECT_THAT(lines, Contains(HasSubstr("plasmons")));
  EXPECT_THAT(lines, Contains(HasSubstr("Joy-Luo")));
  EXPECT_THAT(lines, Contains(HasSubstr("barrier of 3.75 eV")));
  Physics p;
  parse_physics("elastic=browning,secondaries=off,barrier=off", p);
  const auto less = describe(p, material("Si"));
  EXPECT_THAT(less, Contains(HasSubstr("Browning")));
  EXPECT_THAT(less, Not(Contains(HasSubstr("Moeller"))));
}

}  // namespace surf::mc
