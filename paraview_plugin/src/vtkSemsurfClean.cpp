// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfClean.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "checks.h"
#include "pipeline.h"
#include "surf/afm/certainty.h"
#include "surf/afm/clean.h"
#include "surf/core/error.h"

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
    const auto neighbourhood = this->Disc ? Neighbourhood::disc : Neighbourhood::square;
    const int spikes = checked_width(this->SpikeWidth, "Spike Width");
    const int median = checked_width(this->MedianWidth, "Median Width");
    const int closing = checked_width(this->ClosingWidth, "Closing Width");
    pv::need_length(this->SpikeLimit, "Spike Limit");
    std::string name;
    HeightField field = this->Heights(inputs, name);
    pv::work(this, [&](const Watch& watch) {
      CleanSummary summary;
      const double steps = this->RemoveSpikes + this->MedianFilter + this->Closing;
      double done = 0;
      const auto next = [&] {
        const double from = done++;
        return watch.part(from / steps, done / steps);
      };
      constexpr double sigmas = 6;   // noise alone passes it once in a billion
      const double limit_nm = this->SpikeLimit > 0 ? this->SpikeLimit : sigmas * pixel_noise_nm(field);
      if (this->RemoveSpikes && limit_nm > 0)   // without noise nothing is a spike for sure
        field = median_filter(field,
                              {.radius = spikes / 2,
                               .neighbourhood = neighbourhood,
                               .limit_nm = limit_nm,
                               .fill_holes = this->FillHoles,
                               .watch = next()},
                              summary);
      if (this->MedianFilter)
        field = median_filter(field,
                              {.radius = median / 2,
                               .neighbourhood = neighbourhood,
                               .fill_holes = this->FillHoles,
                               .watch = next()},
                              summary);
      if (this->Closing)
        field =
            flat_closing(field, {.width = closing, .fill_holes = this->FillHoles, .watch = next()}, summary);
    });
    pv::give(outputs->GetInformationObject(0), this->WithHeights(inputs, std::move(field), name));
  });
}
