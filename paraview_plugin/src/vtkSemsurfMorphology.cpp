// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfMorphology.h"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "convert/tip.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/workflow/morphology_job.h"

vtkStandardNewMacro(vtkSemsurfMorphology);

using namespace surf;

/// A missing tip is told in our words, and not in VTK's.
int vtkSemsurfMorphology::FillInputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  if (port == 1) info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkSemsurfMorphology::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                      vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    if (this->Operation < Erode || this->Operation > Close)
      throw UsageError("Operation", fmt::format("there is no operation {}", this->Operation),
                       "Choose 0 to 3");
    workflow::MorphologyParameters parameters;
    this->Values->apply(parameters);
    const auto operation = static_cast<workflow::MorphologyOperation>(this->Operation);
    std::string name;
    HeightField field = this->Heights(inputs, name);
    vtkImageData* const tip_image = pv::image_input(inputs, 1, "Tip");
    std::vector<std::string> warnings;
    const Tip tip =
        pv::to_tip_for(tip_image, tip_image ? pv::chosen_array(this, 1, tip_image) : nullptr, field,
                       "Tip", warnings);
    pv::work(this, [&](const Watch& watch) {
      field = workflow::morphology(operation, field, tip, parameters, pv::hear(watch, warnings));
    });
    pv::warn(this, warnings);
    const auto image = this->WithHeights(inputs, std::move(field), name);
    pv::add_record(image, workflow::name(operation), record_of(parameters));
    pv::give(outputs->GetInformationObject(0), image);
  });
}
