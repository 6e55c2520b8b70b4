// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/materials.h"

#include <set>

#include "surf/mc/physics/element.h"

#include "../io_test.h"

namespace surf::io {
namespace {

using testing::HasSubstr;

TEST(Materials, AreValidAndNamedOnce) {
  std::set<std::string> names;
  for (const mc::Material& material : builtin_materials()) {
    EXPECT_NO_THROW(mc::validate(material));
    EXPECT_TRUE(names.insert(material.name).second) << material.name;
    EXPECT_FALSE(material.sources.empty()) << material.name;
  }
  EXPECT_TRUE(names.count("Si"));
}

TEST(Materials, SiliconIsSilicon) {
  const mc::Material& si = find_material("Si", "--material");
  EXPECT_EQ(si.name, "Si");
  EXPECT_NEAR(si.density_g_cm3, 2.33, 0.01);
  ASSERT_EQ(si.constituents.size(), 1u);
  EXPECT_EQ(si.constituents[0].atomic_number, 14);
  EXPECT_NEAR(si.constituents[0].atomic_weight, 28.086, 0.002);
  EXPECT_EQ(si.constituents[0].weight_fraction, 1);
  EXPECT_GT(si.constituents[0].mean_ionization_ev, 100);
  EXPECT_GT(si.loss_join_ev, si.barrier_ev);
}

TEST(Materials, UnknownNamesAreAnsweredWithTheNearestFirst) {
  EXPECT_THAT(
      test::complaint<UsageError>([] { find_material("si", "--material"); }),
      testing::AllOf(HasSubstr("--material: "), HasSubstr("'si'"), HasSubstr("Did you mean Si?")));
  EXPECT_THAT(test::complaint<UsageError>([] { find_material("Sii", "--material"); }),
              HasSubstr("Choose one of: Si"));
}

TEST(Materials, AreAllThatAreKnown) {
  std::vector<std::string> names;
  for (const mc::Material& material : builtin_materials()) names.push_back(material.name);
  EXPECT_THAT(names,
              testing::ElementsAre("Si", "SiO2", "C", "graphite", "Al", "Cu", "Au", "Ag", "W", "Ge",
                                   "Ti", "TiO2", "Cr", "Ni", "Mo", "Pt", "Fe", "Ta", "PMMA"));
}

// Only E_b may be missing in the file, and is not called fitted then.
TEST(Materials, EstimateNothingButTheJoin) {
  for (const mc::Material& material : builtin_materials()) {
    for (const mc::EstimatedValue& e : material.estimates) {
      EXPECT_EQ(e.field, "loss_join_ev") << material.name;
      EXPECT_FALSE(material.loss_join_fitted) << material.name;
      EXPECT_THAT(material.sources, HasSubstr("E_b: estimated"));
    }
    for (const mc::Constituent& c : material.constituents) {
      EXPECT_TRUE(mc::has_mott_table(c.atomic_number)) << material.name;
      EXPECT_NEAR(c.atomic_weight, mc::element(c.atomic_number).atomic_weight, 0.003);
      EXPECT_NEAR(c.mean_ionization_ev, mc::mean_ionization_ev(c.atomic_number), 0.1);
    }
  }
}

// The plasmon must be able to free a secondary.
TEST(Materials, HavePlasmonsAboveTheWorkFunction) {
  for (const mc::Material& material : builtin_materials())
    EXPECT_GT(material.plasmon_ev, material.work_function_ev) << material.name;
}

class MaterialFileTest : public testing::Test {
 protected:
  void read(const std::string& text) { library_.read(test::write(path_, text), notes_); }

  template <class E>
  std::string refused(const std::string& text) {
    return test::complaint<E>([&] { read(text); });
  }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "mine.toml";
  MaterialLibrary library_;
  std::vector<std::string> notes_;
};

const char* const nitride =
    "[[material]]\nname = \"nitride\"\nformula = \"Si3N4\"\ndensity_g_cm3 = 3.17\n";

TEST_F(MaterialFileTest, AddsMaterialsAndKeepsTheBuiltInOnes) {
  read(std::string(nitride) + "band_gap_ev = \"0.0053keV\"\n" +
       "[[material]]\nname = \"brass\"\ndensity_g_cm3 = 8.5\nelements = [{ symbol = \"Cu\", "
       "weight_fraction = 0.63 }, { Z = 30, weight_fraction = 0.37, A = 65.4, J_ev = 330 }]\n");
  EXPECT_EQ(library_.all().size(), builtin_materials().size() + 2);
  EXPECT_DOUBLE_EQ(library_.find("nitride", "test").work_function_ev, 6.3);
  const mc::Material& brass = library_.find("brass", "test");
  EXPECT_EQ(brass.constituents[0].atomic_number, 29);
  EXPECT_EQ(brass.constituents[1].atomic_weight, 65.4);
  EXPECT_EQ(brass.constituents[1].mean_ionization_ev, 330);
  EXPECT_EQ(library_.find("Si", "test").density_g_cm3, 2.33);
  EXPECT_TRUE(notes_.empty());
  EXPECT_THAT(test::complaint<UsageError>([&] { library_.find("nitrid", "--material"); }),
              HasSubstr("Choose one of: nitride"));
}

TEST_F(MaterialFileTest, ReplacesOnesOfTheSameNameAndSaysSo) {
  read("[[material]]\nname = \"Au\"\nformula = \"Au\"\ndensity_g_cm3 = 15\n");
  EXPECT_EQ(library_.all().size(), builtin_materials().size());
  EXPECT_EQ(library_.find("Au", "test").density_g_cm3, 15);
  EXPECT_EQ(library_.find("Au", "test").barrier_ev, find_material("Au", "test").barrier_ev);
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_THAT(notes_[0], testing::AllOf(HasSubstr("Au is as "), HasSubstr("mine.toml"),
                                        HasSubstr("in place of the built-in one")));
  read("[[material]]\nname = \"Au\"\nformula = \"Au\"\ndensity_g_cm3 = 14\n");
  EXPECT_THAT(notes_.back(), HasSubstr("in place of that of"));
  EXPECT_EQ(find_material("Au", "test").density_g_cm3, 19.282) << "the built-in one stays";
}

TEST_F(MaterialFileTest, TakesWhatLossesInEventsNeed) {
  test::write(folder_.path() / "nitride.csv",
              "# made for a test; source: me\n# 100 400 "
              "-1\n5,0.1\n20,1\n24,1.2\n40,0.2\n100,0.02\n1000,1e-5\n");
  read(std::string(nitride) +
       "band_gap_ev = 5.3\n[material.dielectric]\nenergy_loss_function = "
       "\"nitride.csv\"\nfilled_band_ev = 8\nvacuum_ev = \"7.3eV\"\n"
       "sound_m_s = [11000, 6200]\ndeformation_ev = [8, 5]\noptical_phonons = [{ energy_ev = 0.11, "
       "high_permittivity = 4, "
       "low_permittivity = 7.5 }]\ntrap_per_nm = 0.1\ntrap_ev = 1\nsources = \"a test\"\n");
  const mc::DielectricData& d = *library_.find("nitride", "test").dielectric;
  EXPECT_EQ(d.elf.source(), "me");
  EXPECT_DOUBLE_EQ(d.elf(20), 1);
  EXPECT_EQ(d.band.filled_ev, 8);
  EXPECT_EQ(d.barrier_ev(), 15.3);
  ASSERT_EQ(d.acoustic.size(), 2u);
  EXPECT_EQ(d.acoustic[1].speed_m_s, 6200);
  EXPECT_EQ(d.acoustic[1].deformation_ev, 5);
  EXPECT_EQ(d.acoustic[1].count, 2);
  ASSERT_EQ(d.optical.size(), 1u);
  EXPECT_EQ(d.optical[0].low_permittivity, 7.5);
  EXPECT_EQ(d.trap_per_nm, 0.1);
  EXPECT_EQ(d.sources, "a test");
}

TEST_F(MaterialFileTest, NamesMistakesInWhatLossesInEventsNeed) {
  const std::string start = std::string(nitride) + "band_gap_ev = 5.3\n[material.dielectric]\n";
  EXPECT_THAT(refused<FileError>(start + "energy_loss = \"x.csv\"\n"), HasSubstr("energy_loss"));
  EXPECT_THAT(refused<FileError>(start + "energy_loss_function = \"missing.csv\"\n"),
              HasSubstr("missing.csv"));
  EXPECT_THAT(refused<UsageError>(start + "sound_m_s = [1000, 2000]\ndeformation_ev = [3]\n"),
              HasSubstr("as many as in sound_m_s"));
  EXPECT_THAT(refused<UsageError>(start + "sound_m_s = [1000, 2000, 3000]\n"),
              HasSubstr("3 speeds"));
  EXPECT_THAT(refused<FileError>(start + "optical_phonons = [{ energy_ev = 0.1 }]\n"),
              HasSubstr("high_permittivity"));
  EXPECT_THAT(refused<InvalidInput>(start + "filled_band_ev = 1000\n"),
              HasSubstr("dielectric.filled_band_ev is 1000"));
}

TEST_F(MaterialFileTest, MistakesAreNamedWithTheirPlace) {
  EXPECT_THAT(
      refused<FileError>(std::string(nitride) + "bandgap = 5\n"),
      testing::AllOf(HasSubstr("line 5, column 1"), HasSubstr("Did you mean 'band_gap_ev'")));
  EXPECT_THAT(refused<FileError>("[substrate]\n"), HasSubstr("'substrate' is not known"));
  EXPECT_THAT(refused<FileError>(""), HasSubstr("holds no material"));
  EXPECT_THAT(refused<FileError>("[[material]]\nformula = \"Si\"\n"),
              HasSubstr("'name' is missing"));
  EXPECT_THAT(refused<FileError>("[[material]]\nname = \"a\"\n"),
              HasSubstr("either 'formula' or 'elements'"));
  EXPECT_THAT(refused<FileError>("[[material]]\nname = \"a\"\nformula = \"Si\"\nelements = []\n"),
              HasSubstr("not both"));
  EXPECT_THAT(refused<FileError>("[[material]]\nname = \"a\"\nformula = \"Si\"\n"),
              HasSubstr("'density_g_cm3' is missing"));
  const std::string start = "[[material]]\nname = \"a\"\ndensity_g_cm3 = 1\n";
  EXPECT_THAT(refused<UsageError>(start + "formula = \"SiQ\""),
              testing::AllOf(HasSubstr("line 4, material[1].formula"), HasSubstr("'Q'")));
  EXPECT_THAT(refused<UsageError>(start + "elements = [{ symbol = \"Qq\" }]"), HasSubstr("'Qq'"));
  EXPECT_THAT(refused<UsageError>(start + "elements = [{ Z = 93 }]"), HasSubstr("no element 93"));
  EXPECT_THAT(refused<FileError>(start + "elements = [{ weight_fraction = 1 }]"),
              HasSubstr("either 'Z' or 'symbol'"));
  EXPECT_THAT(refused<InvalidInput>(start + "formula = \"Si\"\nband_gap_ev = -1"),
              testing::AllOf(HasSubstr("line 1, material[1]"), HasSubstr("material a"),
                             HasSubstr("band_gap_ev is -1")));
  EXPECT_THAT(refused<UsageError>(std::string(nitride) + nitride),
              HasSubstr("two materials 'nitride'"));
  EXPECT_THAT(refused<UsageError>("[[material]]\nname = \"\"\nformula = \"Si\"\n"),
              HasSubstr("name is empty"));
}

}  // namespace
}  // namespace surf::io
