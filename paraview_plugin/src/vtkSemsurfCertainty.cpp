// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfCertainty.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>

#include <utility>

#include "attempt.h"
#include "convert/tip.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/workflow/certainty_job.h"

vtkStandardNewMacro(vtkSemsurfCertainty);

using namespace surf;

namespace {

/// The channels of `semsurf certainty`'s map, but for the surface, which is the heights here.
void add_map(vtkImageData* image, const Grid<unsigned char>& level) {
  Grid<unsigned char> certain(level.width(), level.height());
  Grid<float> radius(level.width(), level.height());
  for (std::size_t i = 0; i < level.size(); ++i) {
    const bool is_certain = level.data()[i] != CertaintyMap::uncertain;
    certain.data()[i] = is_certain;
    radius.data()[i] = is_certain ? static_cast<float>(level.data()[i]) : -1.0f;
  }
  pv::add_values(image, std::move(certain), "certain", "1");
  pv::add_values(image, std::move(radius), "radius_px", "1");
  image->GetPointData()->SetActiveScalars("certain");
}

}  // namespace

/// A missing tip is told in our words, and not in VTK's.
int vtkSemsurfCertainty::FillInputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  if (port == 1) info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkSemsurfCertainty::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                     vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    workflow::CertaintyParameters parameters;
    this->Values->apply(parameters);
    std::string name;
    const HeightField field = this->Heights(inputs, name);
    vtkImageData* const tip_image = pv::image_input(inputs, 1, "Tip");
    std::vector<std::string> warnings;
    const Tip tip =
        pv::to_tip_for(tip_image, tip_image ? pv::chosen_array(this, 1, tip_image) : nullptr, field,
                       "Tip", warnings);
    workflow::CertaintyResult certain;
    pv::work(this, [&](const Watch& watch) {
      certain = workflow::certainty(field, tip, parameters, pv::hear(watch, warnings));
    });
    pv::warn(this, warnings);
    const auto image = this->WithHeights(inputs, std::move(certain.map.surface), name);
    add_map(image, certain.map.level);
    pv::add_record(image, "certainty", record_of(certain.used));
    pv::give(outputs->GetInformationObject(0), image);
  });
}
