// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfEstimate.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "convert/image.h"
#include "labels.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/workflow/estimate_job.h"

vtkStandardNewMacro(vtkSemsurfEstimate);

using namespace surf;

int vtkSemsurfEstimate::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                    vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::with_labels(
        [&] {
          workflow::EstimateJob job;
          this->Values->apply(job);
          vtkImageData* const input = pv::image_input(inputs, 0, "Input");
          job.image = pv::to_image(input, "Input");
          job.image.metadata = pv::texts_of(input);
          std::vector<std::string> warnings;
          workflow::EstimateSummary summary;
          pv::work(this, [&](const Watch& watch) {
            summary = workflow::run(job, pv::hear(watch, warnings));
          });
          pv::warn(this, warnings);
          pv::give(outputs->GetInformationObject(0), pv::to_vtk(std::move(summary.image)));
        },
        {{"IMAGE", "Input"}});
  });
}
