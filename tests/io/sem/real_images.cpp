// SPDX-License-Identifier: GPL-3.0-or-later
// Real images of five makers against what was read from them by other programs.
#include <nlohmann/json.hpp>

#include "../io_test.h"
#include "surf/io/sem_file.h"

namespace surf::io {
namespace {

using Json = nlohmann::json;

class RealSemImages : public test::RealFiles {};

/// The pixel size that the table has of Zeiss's image is that of the screen's 1024 columns.
double pixel_nm(const Json& truth) {
  const double table = truth.at("pixel_x_nm");
  return truth.at("vendor") == "Zeiss SmartSEM" ? table * 1024 / truth.at("nx").get<double>()
                                                : table;
}

std::optional<double> energy_ev(const Json& truth) {
  if (truth.contains("hv_V")) return truth.at("hv_V").get<double>();
  if (truth.contains("hv_kV")) return 1e3 * std::stod(truth.at("hv_kV").get<std::string>());
  const std::string text = truth.at("hv");
  return text.starts_with("('EHT'") ? 1e3 * std::stod(text.substr(8)) : std::stod(text);
}

int databar_rows(const Json& truth) {
  if (truth.contains("strip_databar_rows"))
    return std::stoi(truth.at("strip_databar_rows").get<std::string>());
  if (truth.contains("full_size")) return truth.at("ny").get<int>() - 960;
  return truth.value("databar_rows", 0);
}

TEST_F(RealSemImages, AreReadAsTheirMakersMeant) {
  const auto list = root_ / "truth" / "sem.json";
  if (!std::filesystem::exists(list)) GTEST_SKIP() << "there is no " << list;
  const Json all = Json::parse(test::content_of(list));
  EXPECT_GE(all.size(), 5u);
  for (const Json& truth : all) {
    const auto path = root_ / truth.at("file").get<std::string>();
    SCOPED_TRACE(path);
    EXPECT_TRUE(is_sem_image_file(path));
    const SemFile file = read_sem_image(path);
    EXPECT_EQ(file.format.substr(file.format == "Thermo/FEI" ? 7 : 0, 3),
              truth.at("vendor").get<std::string>().substr(0, 3));
    EXPECT_NEAR(file.image.pitch_x_nm / pixel_nm(truth), 1, 1e-5);
    EXPECT_EQ(file.image.pitch_y_nm, file.image.pitch_x_nm);
    EXPECT_EQ(file.databar_rows, databar_rows(truth));
    EXPECT_EQ(file.image.values.width(), truth.at("nx").get<int>());
    EXPECT_EQ(file.image.values.height(), truth.at("ny").get<int>() - file.databar_rows);
    EXPECT_EQ(file.bits, truth.at("dtype") == "uint16" ? 16 : 8);
    EXPECT_EQ(file.energy_ev, energy_ev(truth));
    EXPECT_GT(file.working_distance_nm.value_or(0), 1e6);
    EXPECT_THAT(truth.value("detector", truth.value("signal", "")),
                testing::HasSubstr(file.detector));
    EXPECT_FALSE(file.detector.empty());
    EXPECT_FALSE(file.instrument.empty());
  }
}

}  // namespace
}  // namespace surf::io
