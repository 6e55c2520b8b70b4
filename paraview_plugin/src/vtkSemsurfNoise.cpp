// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfNoise.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkTable.h>

#include <utility>

#include "attempt.h"
#include "convert/table.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/workflow/noise_job.h"

vtkStandardNewMacro(vtkSemsurfNoise);

using namespace surf;

namespace {

void add_correlations(vtkTable* table, const NoiseCheck& check) {
  std::vector<std::string> direction;
  std::vector<int> lag;
  std::vector<double> correlation, z;
  for (const auto& [name, lags] :
       {std::pair{"along", &check.along}, std::pair{"across", &check.across}}) {
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

}  // namespace

vtkSemsurfNoise::vtkSemsurfNoise() : Values(std::make_unique<pv::PropertyValues>()) {
  this->SetNumberOfInputPorts(1);
  this->SetNumberOfOutputPorts(2);
}
vtkSemsurfNoise::~vtkSemsurfNoise() = default;

void vtkSemsurfNoise::SetParameter(const char* name, double value) {
  if (this->Values->set(name, value)) this->Modified();
}

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
    workflow::ScanNoiseParameters parameters;
    this->Values->apply(parameters);
    vtkImageData* const image = pv::image_input(inputs, 0, "Input");
    const HeightField field = pv::to_height_field(image, pv::chosen_array(this, 0, image), "Input");
    std::vector<std::string> warnings;
    workflow::ScanNoise noise;
    pv::work(this, [&](const Watch& watch) {
      noise = workflow::noise_of_scan(field, parameters, {}, pv::hear(watch, warnings));
    });
    pv::warn(this, warnings);
    const NoiseCheck check = noise.check.value_or(NoiseCheck{});
    const NoiseEstimate& e = noise.estimate;
    vtkNew<vtkTable> quantities, correlations;
    pv::add_quantities(quantities, {{"alpha", e.noise.alpha},
                                    {"alpha_stderr", e.alpha_stderr},
                                    {"sigma_nm", e.sigma_nm()},
                                    {"sigma_stderr_nm", e.sigma_stderr_nm},
                                    {"innovation_nm2", e.noise.innovation_nm2},
                                    {"innovation_stderr_nm2", e.innovation_stderr_nm2},
                                    {"samples", static_cast<double>(e.samples)},
                                    {"substrate_share", noise.substrate_share},
                                    {"whiteness_along_p", check.along_p},
                                    {"whiteness_across_p", check.across_p},
                                    {"normality_p", check.normal_p},
                                    {"skewness", check.skewness},
                                    {"excess_kurtosis", check.excess_kurtosis}});
    add_correlations(correlations, check);
    pv::add_record(quantities, "noise scan", record_of(parameters));
    pv::give(outputs->GetInformationObject(0), quantities);
    pv::give(outputs->GetInformationObject(1), correlations);
  });
}
