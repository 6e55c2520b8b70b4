// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfNoise.h"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkTable.h>

#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/table.h"
#include "pipeline.h"
#include "surf/afm/noise_check.h"
#include "surf/afm/substrate_noise.h"
#include "surf/core/error.h"

vtkStandardNewMacro(vtkSemsurfNoise);

using namespace surf;

namespace {

struct Findings {
  NoiseEstimate estimate;
  Grid<unsigned char> samples;   // that the estimate rests on
  Grid<double> residual_nm;
  double share = 1;   // of the image
  bool clear = true;
};

Findings of_flat_scan(const HeightField& field, const FlatNoiseOptions& options) {
  Findings f;
  f.estimate = estimate_flat_noise(field, options);
  HeightField residual = field;
  subtract(residual, fit_polynomial(field, options.degree));
  f.residual_nm = std::move(residual.z_nm);
  f.samples =
      field.valid.empty() ? Grid<unsigned char>(field.z_nm.width(), field.z_nm.height(), 1) : field.valid;
  return f;
}

Findings of_substrate(const HeightField& field, const FlatNoiseOptions& options) {
  SubstrateNoise s = estimate_substrate_noise(field, options);
  return {s.estimate, std::move(s.substrate), std::move(s.residual_nm), s.substrate_share,
          s.plane.verdict == HoughVerdict::clear};
}

void add_correlations(vtkTable* table, const NoiseCheck& check) {
  std::vector<std::string> direction;
  std::vector<int> lag;
  std::vector<double> correlation, z;
  for (const auto& [name, lags] : {std::pair{"along", &check.along}, std::pair{"across", &check.across}}) {
    for (const LagCorrelation& l : *lags) {
      direction.push_back(name);
      lag.push_back(l.lag);
      correlation.push_back(l.correlation);
      z.push_back(l.z);
    }
  }
  pv::add_column(table, "direction", direction);
  pv::add_column(table, "lag", std::move(lag));
  pv::add_column(table, "correlation", std::move(correlation));
  pv::add_column(table, "z", std::move(z));
}

}   // namespace

int vtkSemsurfNoise::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkSemsurfNoise::RequestInformation(vtkInformation*, vtkInformationVector**,
                                        vtkInformationVector* outputs) {
  pv::announce_pieces(outputs->GetInformationObject(0));
  return pv::announce_pieces(outputs->GetInformationObject(1));
}

int vtkSemsurfNoise::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                                         vtkInformationVector*) {
  pv::request_whole(inputs, 1);
  return 1;
}

int vtkSemsurfNoise::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                 vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    if (this->Lags < 1 || this->Lags > 1000)
      throw UsageError("Lags", fmt::format("{} is not in 1 to 1000", this->Lags), "Give 10 where in doubt");
    pv::need_within(this->Degree, 0, 6, "Degree");
    vtkImageData* const image = pv::image_input(inputs, 0, "Input");
    const HeightField field = pv::to_height_field(image, pv::chosen_array(this, 0, image), "Input");
    Findings f;
    NoiseCheck check;
    pv::work(this, [&](const Watch& watch) {
      const FlatNoiseOptions options{this->Degree, watch.part(0, 0.9)};
      f = this->Flat ? of_flat_scan(field, options) : of_substrate(field, options);
      if (f.estimate.noise.innovation_nm2 > 0)
        check =
            check_noise(whiten(f.residual_nm, f.estimate.noise, f.samples), f.samples, {.lags = this->Lags});
    });
    if (!f.clear)
      pv::warn(this,
               "no plane holds a clear majority of the image, so there may be no substrate to take the noise "
               "from: "
               "crop the image, or turn Flat on for a flat scan");
    if (!(f.estimate.noise.innovation_nm2 > 0))
      pv::warn(this, "there is no noise at all in these heights: they may be simulated or filtered");
    const NoiseEstimate& e = f.estimate;
    vtkNew<vtkTable> quantities, correlations;
    pv::add_quantities(quantities, {{"alpha", e.noise.alpha},
                                    {"alpha_stderr", e.alpha_stderr},
                                    {"sigma_nm", e.sigma_nm()},
                                    {"sigma_stderr_nm", e.sigma_stderr_nm},
                                    {"innovation_nm2", e.noise.innovation_nm2},
                                    {"innovation_stderr_nm2", e.innovation_stderr_nm2},
                                    {"samples", static_cast<double>(e.samples)},
                                    {"substrate_share", f.share},
                                    {"whiteness_along_p", check.along_p},
                                    {"whiteness_across_p", check.across_p},
                                    {"normality_p", check.normal_p},
                                    {"skewness", check.skewness},
                                    {"excess_kurtosis", check.excess_kurtosis}});
    add_correlations(correlations, check);
    pv::give(outputs->GetInformationObject(0), quantities);
    pv::give(outputs->GetInformationObject(1), correlations);
  });
}
