// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfMorphology.h"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/tip.h"
#include "pipeline.h"
#include "surf/afm/morphology.h"
#include "surf/core/error.h"

vtkStandardNewMacro(vtkSemsurfMorphology);

using namespace surf;

int vtkSemsurfMorphology::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                      vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    if (this->Upsample < 1 || this->Upsample > 32)
      throw UsageError("Upsample", fmt::format("{} is not in 1 to 32", this->Upsample),
                       "Give 1 where in doubt");
    pv::need_length(this->Distance, "Distance");
    std::string name;
    HeightField field = this->Heights(inputs, name);
    vtkImageData* const tip_image = pv::image_input(inputs, 1, "Tip");
    const Tip tip = pv::to_tip_for(tip_image, pv::chosen_array(this, 1, tip_image), field, "Tip");
    if (!tip.doubt.empty()) pv::warn(this, fmt::format("the tip says that it is not to be trusted: {}", tip.doubt));
    pv::work(this, [&](const Watch& watch) {
      const MorphologyOptions options{.upsample = this->Upsample, .watch = watch};
      switch (this->Operation) {
        case Erode:
          field = this->Distance > 0 ? erode_noncontact(field, tip, this->Distance, options)
                                     : erode(field, tip, options);
          break;
        case Dilate:
          field = this->Distance > 0 ? dilate_noncontact(field, tip, this->Distance, options)
                                     : dilate(field, tip, options);
          break;
        case Open: field = opening(field, tip, options); break;
        case Close: field = closing(field, tip, options); break;
        default:
          throw UsageError("Operation", fmt::format("there is no operation {}", this->Operation),
                           "Choose 0 to 3");
      }
    });
    pv::give(outputs->GetInformationObject(0), this->WithHeights(inputs, std::move(field), name));
  });
}
