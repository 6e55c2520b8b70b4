// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfClean.h"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "checks.h"
#include "pipeline.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/workflow/clean_job.h"

vtkStandardNewMacro(vtkSemsurfClean);

using namespace surf;

namespace {

int checked_width(int width, const char* property) {
  if (width >= 1 && width <= 2001 && width % 2 == 1) return width;
  throw UsageError(property,
                   fmt::format("{} is no odd number from 1 to 2001, so that there is no middle", width),
                   fmt::format("Give {}", width < 1      ? 3
                                          : width > 2001 ? 2001
                                                         : width + 1));
}

}   // namespace

int vtkSemsurfClean::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                 vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    const int spikes = checked_width(this->SpikeWidth, "Spike Width");
    const int median = checked_width(this->MedianWidth, "Median Width");
    const int closing = checked_width(this->ClosingWidth, "Closing Width");
    pv::need_length(this->SpikeLimit, "Spike Limit");
    workflow::CleanParameters parameters;
    if (this->RemoveSpikes) {
      parameters.spikes = workflow::Spikes{spikes, {}};
      if (this->SpikeLimit > 0) parameters.spikes->limit_nm = this->SpikeLimit;
    }
    if (this->MedianFilter) parameters.median = median;
    if (this->Closing) parameters.closing = closing;
    parameters.disc = this->Disc;
    parameters.fill_holes = this->FillHoles;
    std::string name;
    const HeightField scan = this->Heights(inputs, name);
    std::vector<std::string> warnings;
    workflow::CleanResult cleaned;
    pv::work(this, [&](const Watch& watch) { cleaned = workflow::clean(scan, parameters, pv::hear(watch, warnings)); });
    pv::warn(this, warnings);
    const auto image = this->WithHeights(inputs, std::move(cleaned.field), name);
    pv::add_record(image, "clean", record_of(cleaned.used));
    pv::give(outputs->GetInformationObject(0), image);
  });
}
