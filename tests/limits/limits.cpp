// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "limits/sweep.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::limits {
namespace {

using testing::HasSubstr;

std::string name_of(const testing::TestParamInfo<std::size_t>& info) {
  return sweeps()[info.param].name;
}

class Limits : public testing::TestWithParam<std::size_t> {
 protected:
  const Sweep& sweep() const { return sweeps()[GetParam()]; }
  std::filesystem::path file(const char* extension) const {
    return std::filesystem::path(SEMSURF_LIMITS) / (sweep().name + extension);
  }
};

TEST_P(Limits, OnePointIsMadeAgain) {
  const Table there = from_csv(io::read_file(file(".csv")), file(".csv").string());
  ASSERT_EQ(there.columns, sweep().columns);
  ASSERT_EQ(there.rows.size(), sweep().values.size());
  for (std::size_t i = 0; i < there.rows.size(); ++i) {
    EXPECT_NEAR(there.rows[i][0], sweep().values[i], 1e-8 * std::abs(sweep().values[i]));
    if (sweep().values[i] != sweep().checked) continue;
    const std::vector<double> row = sweep().at(sweep().checked);
    ASSERT_EQ(row.size() + 1, sweep().columns.size());
    for (std::size_t c = 0; c < row.size(); ++c) {
      const double kept = there.rows[i][c + 1];
      ASSERT_EQ(std::isfinite(kept), std::isfinite(row[c])) << sweep().columns[c + 1];
      if (!std::isfinite(kept)) continue;
      EXPECT_NEAR(row[c], kept, sweep().tolerance * std::max(std::abs(kept), 1e-6))
          << sweep().columns[c + 1];
    }
    return;
  }
  ADD_FAILURE() << "the checked value is not in the table";
}

TEST_P(Limits, IsShownOnThePage) {
  EXPECT_TRUE(std::filesystem::exists(file(".svg")));
  std::string pages = io::read_file(SEMSURF_LIMITS_PAGE);
  for (const auto& entry : std::filesystem::directory_iterator(SEMSURF_LIMITS))
    if (entry.path().extension() == ".md") pages += io::read_file(entry.path());
  // "(" on the pages beside the pictures, "/" on docs/explanation/limits.md.
  EXPECT_THAT(pages, testing::AnyOf(HasSubstr("(" + sweep().name + ".svg"),
                                    HasSubstr("limits/" + sweep().name + ".svg")));
}

INSTANTIATE_TEST_SUITE_P(Sweeps, Limits, testing::Range(std::size_t{0}, sweeps().size()), name_of);

TEST(LimitsTable, IsReadBackAsItWasWritten) {
  const Table t{{"x", "y_nm"}, {{1, 0.125}, {2, NAN}}};
  const Table back = from_csv(to_csv(t), "test");
  EXPECT_EQ(back.columns, t.columns);
  EXPECT_EQ(back.rows[0], t.rows[0]);
  EXPECT_TRUE(std::isnan(back.rows[1][1]));
  EXPECT_THROW(from_csv("x,y\n1\n", "test"), InvalidInput);
  EXPECT_THROW(from_csv("x\nz\n", "test"), InvalidInput);
  EXPECT_THROW(back.column("z"), InvalidInput);
}

}  // namespace
}  // namespace surf::limits
