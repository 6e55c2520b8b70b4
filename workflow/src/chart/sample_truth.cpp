// SPDX-License-Identifier: GPL-3.0-or-later
#include "sample_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/tip_file.h"
#include "surf/sem/estimate_sem_noise.h"
#include "surf/workflow/chain_chart_job.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double degree = std::numbers::pi / 180;
constexpr const char* remedy = "Make the sample again: semsurf sample pads -o pads";

PlacedImage placed(const Image& image) {
  PlacedImage out{image.placement(), Grid<double>(image.width(), image.height())};
  std::ranges::copy(image.channels.front().values.data(), out.values.data().begin());
  return out;
}

// Reads the truth except the gains: they are stored by channel, and a model may have only one of
// the channels.
void read_truth(const Json& t, SampleTruth& s) {
  s.name = t.at("sample");
  const Json& sem = t.at("sem");
  s.material = sem.at("material");
  s.energy_ev = sem.at("energy_ev");
  s.spot_nm = sem.at("spot_nm");
  s.sem.offset = sem.at("offset");
  const auto m = t.at("sem_to_afm").get<std::vector<double>>();
  s.sem.sem_to_afm = {m.at(0), m.at(1), m.at(2), m.at(3), m.at(4), m.at(5)};
  const Json& afm = t.at("afm");
  s.afm.noise = {afm.at("noise").at("alpha"), afm.at("noise").at("innovation_nm2")};
  const double offset_nm = afm.at("offset_nm"),
               along_x = std::tan(afm.at("tilt_x_deg").get<double>() * degree),
               along_y = std::tan(afm.at("tilt_y_deg").get<double>() * degree);
  s.afm.image = s.scan;
  HeightField& h = s.afm.image;
  for (int y = 0; y < h.z_nm.height(); ++y)
    for (int x = 0; x < h.z_nm.width(); ++x)
      h.z_nm(x, y) -= offset_nm + along_x * h.x_nm(x) + along_y * h.y_nm(y);
}

}  // namespace

bool is_sample(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "truth.json", ignored);
}

SampleTruth read_sample(const fs::path& folder) {
  if (!is_sample(folder))
    throw UsageError(
        folder.string(),
        "it is a folder without truth.json: errors need a truth, which is known of samples only",
        "Make one with 'semsurf sample pads -o pads', and chart that");
  SampleTruth s;
  s.scan = io::read_height_field(folder / "afm.gsf").field;
  const Image image = io::read_image(folder / "sem.tif");
  if (image.channels.empty())
    throw InvalidInput((folder / "sem.tif").string(), "it holds no signal", remedy);
  s.sem.image = placed(image);
  s.truth = io::read_height_field(folder / "truth.gsf").field;
  if (s.truth.z_nm.width() != image.width() || s.truth.z_nm.height() != image.height())
    throw InvalidInput(
        (folder / "truth.gsf").string(),
        fmt::format("it has {} x {} samples, and sem.tif {} x {} pixels", s.truth.z_nm.width(),
                    s.truth.z_nm.height(), image.width(), image.height()),
        remedy);
  s.afm.tip = io::read_tip(folder / "truth_tip.gsf");
  s.json = io::read_file(folder / "truth.json");
  try {
    read_truth(Json::parse(s.json), s);
  } catch (const std::exception& e) {
    throw FileError((folder / "truth.json").string(),
                    fmt::format("it does not say what is true: {}", e.what()), remedy);
  }
  return s;
}

void give_model(SampleTruth& s, const std::shared_ptr<const ImageModel>& model, int threads) {
  s.sem.model = model;
  s.sem.gains.clear();
  const Json gains = Json::parse(s.json).at("sem").at("gains");
  for (const std::string& channel : model->channels())
    s.sem.gains.push_back(gains.value(channel, 0.0));
  Grid<double> mean(s.truth.z_nm.width(), s.truth.z_nm.height(), s.sem.offset);
  ModelOptions options;
  options.threads = threads;
  const ModelImages made = model->predict(s.truth, options);
  for (std::size_t c = 0; c < made.size(); ++c)
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean.data()[i] += s.sem.gains[c] * made[c].data()[i];
  s.sem.noise = fit_sem_noise(s.sem.image.values, mean, {}).noise;
}

}  // namespace surf::workflow
