// SPDX-License-Identifier: GPL-3.0-or-later
// Models of tables in files: stopping points and the diffusion matrix.
#include <gmock/gmock.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/model/model_file.h"
#include "temporary_folder.h"

namespace surf::io {
namespace {

TrainedModel stopping_points() {
  StoppingPointParameters p{0.75, -1.0 / 3, 0.1, 2, 3, {}};
  p.channels = {{"SE", StoppingRule::counted, {0, 1.0 / 7, 0, 0, 2, 0}},
                {"BSE", StoppingRule::reflected, {0, 1e-9, 0, 0, 0.25, 0}}};
  return {{3, "Si", 1000, 0}, p, {}};
}

TrainedModel diffusion() {
  DiffusionMatrixParameters p{0.75, -1, 0.5, 1, 2, {}};
  p.channels = {{"SE", {0.1, -0.2, 1.0 / 3, 0.4, 0.5, -0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.2}}};
  return {{2, "Au", 500, 0}, p, {}};
}

TEST(BaselineModelFile, ComesBackToTheLastDigit) {
  const test::TemporaryFolder folder;
  for (const TrainedModel& model : {stopping_points(), diffusion()}) {
    const auto file = folder.path() / "model.json", again = folder.path() / "again.json";
    write_model(file, model);
    const TrainedModel back = read_model(file);
    EXPECT_EQ(kind_of(back), kind_of(model));
    EXPECT_EQ(back.scope, model.scope);
    write_model(again, back);
    EXPECT_EQ(read_file(file), read_file(again));
    HeightField field{{model.scope.pixel_nm, model.scope.pixel_nm}, Grid<double>(5, 4)};
    field.z_nm(2, 2) = 0.1;
    EXPECT_EQ(make_model(back)->predict(field), make_model(model)->predict(field));
    EXPECT_EQ(make_model(back)->channels(), make_model(model)->channels());
  }
}

TEST(BaselineModelFile, NamesThePlaceOfAFault) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "model.json";
  const auto complaint = [&](const TrainedModel& model, const std::string& what,
                             const std::string& by) -> std::string {
    write_model(file, model);
    std::string text = read_file(file);
    write_text(file, text.replace(text.find(what), what.size(), by));
    try {
      read_model(file);
    } catch (const FileError& error) {
      return error.what();
    }
    return "read";
  };
  EXPECT_THAT(complaint(stopping_points(), "\"counted\"", "\"guessed\""),
              testing::HasSubstr("no rule 'guessed'"));
  EXPECT_THAT(complaint(stopping_points(), "\"rings\": 2", "\"rings\": 3"),
              testing::HasSubstr("not 3 x 3"));
  EXPECT_THAT(complaint(diffusion(), "\"heights\": 2", "\"heights\": 9000000"),
              testing::HasSubstr("too large"));
  EXPECT_THAT(complaint(diffusion(), "\"moments_per_nm2\"", "\"moments\""),
              testing::HasSubstr("moments_per_nm2"));
}

}  // namespace
}  // namespace surf::io
