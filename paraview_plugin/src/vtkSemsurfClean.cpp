// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfClean.h"

#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "checks.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/workflow/clean_job.h"

vtkStandardNewMacro(vtkSemsurfClean);

using namespace surf;

int vtkSemsurfClean::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                 vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    workflow::CleanParameters parameters;
    this->Values->apply(parameters);
    workflow::check(parameters);  // also widths of steps that are off
    pv::need_length(this->SpikeLimit, "Spike Limit");
    if (!this->RemoveSpikes) parameters.spikes.reset();
    else if (this->SpikeLimit > 0) parameters.spikes->limit_nm = this->SpikeLimit;
    if (!this->MedianFilter) parameters.median.reset();
    if (!this->Closing) parameters.closing.reset();
    std::string name;
    const HeightField scan = this->Heights(inputs, name);
    std::vector<std::string> warnings;
    workflow::CleanResult cleaned;
    pv::work(this, [&](const Watch& watch) {
      cleaned = workflow::clean(scan, parameters, pv::hear(watch, warnings));
    });
    pv::warn(this, warnings);
    const auto image = this->WithHeights(inputs, std::move(cleaned.field), name);
    pv::add_record(image, "clean", record_of(cleaned.used));
    pv::give(outputs->GetInformationObject(0), image);
  });
}
