// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/model/calibration_file.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "temporary_folder.h"

namespace surf::io {
namespace {

CalibrationFile example() {
  CalibrationFile file;
  Calibration& c = file.calibration;
  c.outcome = CalibrationOutcome::doubtful;
  c.channels = {"SE", "BSE"};
  c.gains = {120.0 / 7, -1e-3};
  c.offset = 1.0 / 3;
  c.covariance = {4, 1, 0.1, 1, 9, 0.2, 0.1, 0.2, 0.25};
  c.condition_number = 31.5;
  c.residual_rms = 2.5, c.explained = 0.9, c.residual_correlation = -0.1;
  c.pixels = 4096, c.saturated = 7;
  c.warnings = {"the gain of BSE is below 0"};
  file.range_nm = 500;
  file.notes = {{"semsurf.version", "1"}, {"input.1", "a.png \"b\""}};
  return file;
}

TEST(CalibrationFile, ComesBackToTheLastDigit) {
  const test::TemporaryFolder folder;
  CalibrationFile file = example();
  const auto path = folder.path() / "c.json";
  write_calibration(path, file);
  const CalibrationFile back = read_calibration(path);
  EXPECT_EQ(back.calibration.outcome, CalibrationOutcome::doubtful);
  EXPECT_EQ(back.calibration.channels, file.calibration.channels);
  EXPECT_EQ(back.calibration.gains, file.calibration.gains);
  EXPECT_EQ(back.calibration.offset, file.calibration.offset);
  EXPECT_EQ(back.calibration.covariance, file.calibration.covariance);
  EXPECT_EQ(back.calibration.gain_stderr(1), 3);
  EXPECT_EQ(back.calibration.offset_stderr(), 0.5);
  EXPECT_EQ(back.calibration.condition_number, 31.5);
  EXPECT_EQ(back.calibration.residual_correlation, -0.1);
  EXPECT_EQ(back.calibration.pixels, 4096);
  EXPECT_EQ(back.calibration.saturated, 7);
  EXPECT_EQ(back.calibration.warnings, file.calibration.warnings);
  EXPECT_EQ(back.range_nm, 500);
  EXPECT_EQ(back.notes, file.notes);
  write_calibration(folder.path() / "again.json", back);
  EXPECT_EQ(read_file(path), read_file(folder.path() / "again.json"));
}

TEST(CalibrationFile, KeepsThatGainsAreUndetermined) {
  const test::TemporaryFolder folder;
  CalibrationFile file = example();
  Calibration& c = file.calibration;
  c.outcome = CalibrationOutcome::undetermined;
  c.condition_number = INFINITY;
  c.covariance = {INFINITY, 0, 0, 0, INFINITY, 0, 0, 0, 0};
  write_calibration(folder.path() / "c.json", file);
  const Calibration back = read_calibration(folder.path() / "c.json").calibration;
  EXPECT_EQ(back.outcome, CalibrationOutcome::undetermined);
  EXPECT_EQ(back.condition_number, INFINITY);
  EXPECT_EQ(back.covariance, c.covariance);
}

TEST(CalibrationFile, NamesThePlaceOfAFault) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "c.json";
  write_calibration(path, example());
  const std::string good = read_file(path);
  const auto reason_with = [&](const std::string& word, const std::string& instead) -> std::string {
    std::string text = good;
    text.replace(text.find(word), word.size(), instead);
    write_text(path, text);
    try {
      read_calibration(path);
    } catch (const FileError& error) {
      return error.what();
    }
    return "read";
  };
  EXPECT_THAT(reason_with("\"calibration\"", "\"model\""), ::testing::HasSubstr("no calibration"));
  EXPECT_THAT(reason_with("\"version\": 1", "\"version\": 2"),
              ::testing::HasSubstr("another version"));
  EXPECT_THAT(reason_with("doubtful", "sure"),
              ::testing::HasSubstr("outcome: 'sure' is no outcome"));
  EXPECT_THAT(reason_with("\"gain\"", "\"main\""),
              ::testing::HasSubstr("channels[0]: 'gain' is missing"));
  EXPECT_THAT(reason_with("\"covariance\": [", "\"covariance\": [ 1,"),
              ::testing::HasSubstr("10 numbers, not 3 x 3"));
}

}  // namespace
}  // namespace surf::io
