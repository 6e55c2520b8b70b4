// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/model/model_file.h"
#include "temporary_folder.h"

namespace surf::io {
namespace {

using testing::HasSubstr;

TrainedModel network(bool sided = false) {
  FacetNetworkParameters p;
  p.sided = sided;
  p.scales = {{5, 0.6}, {9, 1.0 / 3}};
  p.sky_edges_nm = {0, 4.1, 10 * (0.1 + 0.2)};
  p.sky_edges_nm[2] += 10;
  const int inputs = network_inputs(p);
  int from = inputs;
  double number = 0;
  for (const int to : {3, 2}) {
    DenseLayer layer{from, to, {}, {}};
    for (int i = 0; i < from * to; ++i)
      layer.weights.push_back(std::sin(++number) * std::pow(10, i % 7 - 5));
    for (int i = 0; i < to; ++i) layer.biases.push_back(std::cos(++number));
    p.layers.push_back(layer);
    from = to;
  }
  p.layers[0].weights[0] = std::numeric_limits<double>::denorm_min();
  p.layers[1].weights[0] = -0.0;
  p.channels = {{"SE", 0.1 + 0.2}, {"BSE", std::nextafter(1.0, 2.0)}};
  return {{3, "Si", 1000, 0.5}, p, {}};
}

class FacetNetworkFile : public testing::Test {
 protected:
  /// The message that reading gives once a text of the file is replaced.
  std::string complaint(const std::string& what, const std::string& by) {
    write_model(file_, network(what.find("sided") != std::string::npos));
    std::string text = read_file(file_);
    const auto parameters = text.find("\"parameters\"");
    const auto at = text.find(what, parameters);
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

void expect_same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0);
}

TEST_F(FacetNetworkFile, ComesBackToTheLastBit) {
  const TrainedModel model = network();
  write_model(file_, model);
  const TrainedModel back = read_model(file_);
  EXPECT_EQ(kind_of(back), "facet network");
  EXPECT_EQ(back.scope, model.scope);
  const auto &a = std::get<FacetNetworkParameters>(model.parameters),
             &b = std::get<FacetNetworkParameters>(back.parameters);
  EXPECT_EQ(b.scales, a.scales);
  expect_same_bits(b.sky_edges_nm, a.sky_edges_nm);
  ASSERT_EQ(b.layers.size(), a.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    EXPECT_EQ(b.layers[i].inputs, a.layers[i].inputs);
    EXPECT_EQ(b.layers[i].outputs, a.layers[i].outputs);
    expect_same_bits(b.layers[i].weights, a.layers[i].weights);
    expect_same_bits(b.layers[i].biases, a.layers[i].biases);
  }
  ASSERT_EQ(b.channels.size(), a.channels.size());
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    EXPECT_EQ(b.channels[i].name, a.channels[i].name);
    EXPECT_EQ(b.channels[i].scale, a.channels[i].scale);
  }
  const std::string bytes = read_file(file_);
  write_model(file_, back);
  EXPECT_EQ(read_file(file_), bytes);
}

TEST_F(FacetNetworkFile, SaysWhetherItTellsSides) {
  for (const bool sided : {false, true}) {
    write_model(file_, network(sided));
    EXPECT_EQ(std::get<FacetNetworkParameters>(read_model(file_).parameters).sided, sided);
    EXPECT_EQ(read_file(file_).find("\"sided\"") != std::string::npos, sided);
  }
  EXPECT_THAT(complaint("\"sided\": true", "\"sided\": 1"), HasSubstr("sided"));
}

TEST_F(FacetNetworkFile, NamesWhatIsMissing) {
  for (const char* key : {"scales", "size", "sigma_px", "sky_edges_nm", "channels", "name", "scale",
                          "layers", "inputs", "outputs", "weights", "biases"})
    EXPECT_THAT(complaint(std::string("\"") + key + "\":", "\"gone\":"),
                HasSubstr(std::string("'") + key + "' is missing"));
}

TEST_F(FacetNetworkFile, RefusesParametersThatNoNetworkHas) {
  EXPECT_THAT(complaint("\"size\": 5", "\"size\": 6"), HasSubstr("parameters"));
  EXPECT_THAT(complaint("\"inputs\": 13", "\"inputs\": 12"),
              HasSubstr("layer 1 goes from 12 to 3"));
  EXPECT_THAT(complaint("\"outputs\": 3", "\"outputs\": 4"), HasSubstr("39 weights and 3 biases"));
  EXPECT_THAT(complaint("\"outputs\": 3", "\"outputs\": 1e15"),
              HasSubstr("layers[0].outputs: it is too large"));
  EXPECT_THAT(complaint("\"outputs\": 3", "\"outputs\": -3"), HasSubstr("layers[0].outputs"));
  EXPECT_THAT(complaint("4.1", "-4.1"), HasSubstr("a limit of its sky bands is -4.1"));
  EXPECT_THAT(complaint("\"BSE\"", "\"SE\""), HasSubstr("SE"));
  EXPECT_THAT(complaint("\"weights\": [", "\"weights\": [null, "),
              HasSubstr("weights[0]: a finite number"));
}

}  // namespace
}  // namespace surf::io
