// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/model/model_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "temporary_folder.h"

namespace surf::io {
namespace {

using testing::HasSubstr;

TrainingRecord some_record() {
  TrainingRecord record;
  const ModelResidual se{"SE", 0.1 + 0.2, 1e-300, 1.0 / 3, 0.9, 123456789012},
      bse{"BSE", 0.05, 0, 0.02, 0.2, 7};
  record.scenes = {{"blocks", "ab12", 96, 64, 400, false, {se, bse}},
                   {"a \"quoted\" µ", "", 5, 4, 0, true, {}}};
  record.residuals = {se, bse};
  record.held_out_residuals = {bse, se};
  record.range = {71.5, 83.25, 0.1, 1.7};
  record.condition_number = 1234.5;
  record.warnings = {"few pixels", "line\nbreak"};
  record.notes = {{"seed", "1"}, {"command", "semsurf train 'a b'"}};
  return record;
}

TrainedModel bank() {
  FilterBankParameters p;
  p.scales = thesis_scales();
  p.multi_resolution = false;
  for (const char* name : {"SE", "BSE"}) {
    FilterBankChannel c{name, std::nextafter(1.0, 2.0), {}, {}, {}};
    for (std::size_t i = 0; i < p.scales.size(); ++i) {
      c.slope.push_back(std::sin(1.0 + double(i)) * 1e-7);
      c.max_curvature.push_back(-5e-324 * double(i));
      c.min_curvature.push_back(std::exp(double(i) * 3));
    }
    p.channels.push_back(c);
  }
  return {{3, "Si", 1000, 0.5}, p, some_record()};
}

TrainedModel table() {
  SlopeModelParameters p;
  p.form = SlopeForm::table;
  p.facet = {7, 0.9};
  p.channels = {{"SE", 1, {1, 1.1, 1.0 / 3}}, {"BSE", 1, {0.2, 0.3, 0.5}}};
  return {{1, "Au", 5000, 0}, p, {}};
}

void expect_same(const std::vector<ModelResidual>& a, const std::vector<ModelResidual>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].channel, b[i].channel);
    EXPECT_EQ(a[i].rms, b[i].rms);
    EXPECT_EQ(a[i].noise_rms, b[i].noise_rms);
    EXPECT_EQ(a[i].mean_relative, b[i].mean_relative);
    EXPECT_EQ(a[i].mean_signal, b[i].mean_signal);
    EXPECT_EQ(a[i].pixels, b[i].pixels);
  }
}

class ModelFile : public testing::Test {
 protected:
  TrainedModel through_a_file(const TrainedModel& model) {
    write_model(file_, model);
    return read_model(file_);
  }

  /// The message that reading gives once a text of the file is replaced.
  std::string complaint(const TrainedModel& model, const std::string& what, const std::string& by) {
    write_model(file_, model);
    std::string text = read_file(file_);
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    write_text(file_, text.replace(at, what.size(), by));
    try {
      read_model(file_);
    } catch (const FileError& error) {
      EXPECT_FALSE(error.remedy().empty());
      return error.what();
    }
    return "nothing";
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "model.json";
};

TEST_F(ModelFile, GivesAFilterBankBackToTheLastDigit) {
  const TrainedModel model = bank(), read = through_a_file(model);
  EXPECT_EQ(read.scope, model.scope);
  const auto &a = std::get<FilterBankParameters>(model.parameters),
             &b = std::get<FilterBankParameters>(read.parameters);
  EXPECT_EQ(b.scales, a.scales);
  EXPECT_EQ(b.multi_resolution, a.multi_resolution);
  ASSERT_EQ(b.channels.size(), a.channels.size());
  for (std::size_t c = 0; c < a.channels.size(); ++c) {
    EXPECT_EQ(b.channels[c].name, a.channels[c].name);
    EXPECT_EQ(b.channels[c].offset, a.channels[c].offset);
    EXPECT_EQ(b.channels[c].slope, a.channels[c].slope);
    EXPECT_EQ(b.channels[c].max_curvature, a.channels[c].max_curvature);
    EXPECT_EQ(b.channels[c].min_curvature, a.channels[c].min_curvature);
  }
  EXPECT_EQ(kind_of(read), "filter bank");
}

TEST_F(ModelFile, GivesEverySlopeModelBack) {
  for (const SlopeForm form :
       {SlopeForm::secant, SlopeForm::ikeuchi_exponential, SlopeForm::ikeuchi_secant,
        SlopeForm::ikeuchi_mixed, SlopeForm::table}) {
    TrainedModel model = table();
    auto& p = std::get<SlopeModelParameters>(model.parameters);
    p.form = form;
    const TrainedModel read = through_a_file(model);
    const auto& q = std::get<SlopeModelParameters>(read.parameters);
    EXPECT_EQ(q.form, form);
    EXPECT_EQ(q.facet, p.facet);
    EXPECT_EQ(q.table_step_deg, p.table_step_deg);
    ASSERT_EQ(q.channels.size(), 2u);
    EXPECT_EQ(q.channels[1].yields, p.channels[1].yields);
  }
}

TEST_F(ModelFile, GivesTheRecordBack) {
  const TrainingRecord a = some_record(), b = through_a_file(bank()).record;
  ASSERT_EQ(b.scenes.size(), a.scenes.size());
  for (std::size_t i = 0; i < a.scenes.size(); ++i) {
    EXPECT_EQ(b.scenes[i].name, a.scenes[i].name);
    EXPECT_EQ(b.scenes[i].sha256, a.scenes[i].sha256);
    EXPECT_EQ(b.scenes[i].width, a.scenes[i].width);
    EXPECT_EQ(b.scenes[i].height, a.scenes[i].height);
    EXPECT_EQ(b.scenes[i].electrons, a.scenes[i].electrons);
    EXPECT_EQ(b.scenes[i].held_out, a.scenes[i].held_out);
    expect_same(b.scenes[i].residuals, a.scenes[i].residuals);
  }
  expect_same(b.residuals, a.residuals);
  expect_same(b.held_out_residuals, a.held_out_residuals);
  EXPECT_EQ(b.range, a.range);
  EXPECT_EQ(b.condition_number, a.condition_number);
  EXPECT_EQ(b.warnings, a.warnings);
  EXPECT_EQ(b.notes, a.notes);
}

TEST_F(ModelFile, HoldsAnInfiniteConditionNumber) {
  TrainedModel model = bank();
  model.record.condition_number = HUGE_VAL;
  EXPECT_EQ(through_a_file(model).record.condition_number, HUGE_VAL);
}

TEST_F(ModelFile, HasTheSameBytesForTheSameModelAndFitsAScreen) {
  write_model(file_, bank());
  const std::string first = read_file(file_);
  write_model(file_, read_model(file_));
  EXPECT_EQ(read_file(file_), first);
  std::size_t longest = 0;
  for (std::size_t from = 0, to; (to = first.find('\n', from)) != std::string::npos; from = to + 1)
    longest = std::max(longest, to - from);
  EXPECT_LE(longest, 110u);
}

TEST_F(ModelFile, NamesWhatIsMissing) {
  for (const char* key : {"format",
                          "version",
                          "kind",
                          "scope",
                          "training",
                          "parameters",
                          "pixel_nm",
                          "energy_ev",
                          "material",
                          "spot_nm",
                          "scales",
                          "channels",
                          "sigma_px",
                          "size",
                          "offset",
                          "slope",
                          "max_curvature_nm",
                          "min_curvature_nm",
                          "multi_resolution",
                          "condition_number",
                          "residuals",
                          "surfaces",
                          "slope_deg_max",
                          "scenes",
                          "name",
                          "width",
                          "rms",
                          "pixels"}) {
    const std::string quoted = std::string("\"") + key + "\":";
    const std::string said = complaint(bank(), quoted, "\"gone\":");
    EXPECT_THAT(said, HasSubstr(file_.string()));
    EXPECT_THAT(said, testing::AnyOf(HasSubstr(std::string("'") + key + "' is missing"),
                                     HasSubstr("it is no model")));
  }
  for (const char* key : {"form", "facet", "flat_yield", "yields", "table_step_deg"})
    EXPECT_THAT(complaint(table(), std::string("\"") + key + "\":", "\"gone\":"),
                HasSubstr(std::string("'") + key + "' is missing"));
}

TEST_F(ModelFile, NamesWhatIsNotFinite) {
  EXPECT_THAT(complaint(bank(), "\"pixel_nm\": 3.0", "\"pixel_nm\": null"),
              HasSubstr("scope.pixel_nm: a finite number"));
  EXPECT_THAT(complaint(bank(), "\"energy_ev\": 1000.0", "\"energy_ev\": -1000"),
              HasSubstr("scope.energy_ev: it is negative"));
  EXPECT_THAT(complaint(bank(), "1000.0", "1e999"), HasSubstr("its JSON is broken"));
  EXPECT_THAT(complaint(table(), "[0.2, 0.3, 0.5]", "[0.2, null, 0.5]"),
              HasSubstr("yields[1]: a finite number"));
}

TEST_F(ModelFile, RefusesOtherKindsVersionsAndFiles) {
  EXPECT_THAT(
      complaint(bank(), "\"filter bank\"", "\"neural\""),
      testing::AllOf(HasSubstr("no kind of model 'neural'"), HasSubstr("'filter bank', 'slope'")));
  EXPECT_THAT(complaint(table(), "\"table\"", "\"cubic\""), HasSubstr("no form 'cubic'"));
  EXPECT_THAT(complaint(bank(), "\"version\": 1", "\"version\": 2"),
              HasSubstr("version 2, this semsurf reads 1"));
  EXPECT_THAT(complaint(bank(), "semsurf image model", "geojson"), HasSubstr("it is no model"));
}

TEST_F(ModelFile, RefusesParametersThatNoModelHas) {
  EXPECT_THAT(complaint(bank(), "\"size\": 5", "\"size\": 6"), HasSubstr("parameters"));
  EXPECT_THAT(complaint(bank(), "\"size\": 5", "\"size\": 1e15"),
              HasSubstr("scales[0].size: it is too large"));
}

TEST_F(ModelFile, SurvivesBeingCutOffAnywhere) {
  write_model(file_, table());
  const std::string whole = read_file(file_);
  for (std::size_t length = 0; length + 1 < whole.size(); length += 7) {
    write_text(file_, whole.substr(0, length));
    EXPECT_THROW(read_model(file_), FileError) << length;
  }
}

TEST_F(ModelFile, WritesNothingThatCannotBeRead) {
  TrainedModel model = bank();
  model.record.range.slope_deg_max = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { write_model(file_, model); },
              testing::ThrowsMessage<InvalidInput>(
                  HasSubstr("training.surfaces.slope_deg_max: it is not finite")));
  EXPECT_FALSE(std::filesystem::exists(file_));
  EXPECT_THROW(write_model(folder_.path() / "model.txt", bank()), UsageError);
}

TEST_F(ModelFile, IsToldFromOtherFiles) {
  write_model(file_, bank());
  EXPECT_TRUE(is_model_file(file_));
  write_text(folder_.path() / "other.json", "{\"format\": \"other\"}");
  EXPECT_FALSE(is_model_file(folder_.path() / "other.json"));
  EXPECT_FALSE(is_model_file(folder_.path() / "missing.json"));
}

}  // namespace
}  // namespace surf::io
