// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/measured_yields.h"

#include <gmock/gmock.h>

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

std::vector<MeasuredYield> read(const std::string& text) {
  const test::TemporaryFolder folder;
  io::write_text(folder.path() / "table.csv", text);
  return read_measured_yields(folder.path() / "table.csv");
}

TEST(MeasuredYields, AreReadByTheNamesOfTheirColumns) {
  const auto se = read(
      "set,energy_keV,element,delta,note\r\n"
      "\"Smith, 1980\",0.5,Si,1.25,\"a, b\"\r\n\r\n,2,PMMA,0.75,\r\n");
  ASSERT_EQ(se.size(), 2u);
  EXPECT_EQ(se[0].material, "Si");
  EXPECT_EQ(se[0].energy_ev, 500);
  EXPECT_EQ(se[0].yield, 1.25);
  EXPECT_FALSE(se[0].backscattered);
  EXPECT_EQ(se[1].material, "PMMA");
  const auto bse = read("element,energy_keV,eta\nAu,10,0.5");
  ASSERT_EQ(bse.size(), 1u);
  EXPECT_TRUE(bse[0].backscattered);
}

TEST(MeasuredYields, OfAnotherQuantityArePassedOver) {
  EXPECT_EQ(read("element,energy_keV,delta,quantity\nC,1,0.5,SE\nC,1,0.6,SE+BSE\n").size(), 1u);
}

TEST(MeasuredYields, SayWhatIsWrongAndWhere) {
  const auto fault = [](const std::string& text) {
    try {
      read(text);
    } catch (const FileError& error) {
      return error.reason();
    }
    return std::string("none");
  };
  EXPECT_THAT(fault(""), testing::HasSubstr("columns"));
  EXPECT_THAT(fault("element,energy_keV\n"), testing::HasSubstr("columns"));
  EXPECT_EQ(fault("element,energy_keV,delta\nSi,1,2\nSi,x,2\n"), "line 3: 'x' is no energy_keV");
  EXPECT_EQ(fault("element,energy_keV,delta\nSi,1\n"), "line 2: '' is no delta");
  EXPECT_EQ(fault("element,energy_keV,delta\nSi,1,nan\n"), "line 2: 'nan' is no delta");
  EXPECT_EQ(fault("element,energy_keV,delta\nSi,1,-2\n"), "line 2: '-2' is no delta");
  EXPECT_THROW(read_measured_yields("nowhere.csv"), FileError);
}

}  // namespace
}  // namespace surf::workflow
