// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfCertainty.h"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>

#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/tip.h"
#include "pipeline.h"
#include "surf/afm/certainty.h"
#include "surf/core/error.h"

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

}   // namespace

int vtkSemsurfCertainty::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                     vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::need_number(this->Noise, "Noise");
    if (!(this->Sigmas > 0 && this->Sigmas <= 1e6))
      throw UsageError("Sigmas", fmt::format("{} is not above 0, up to 1e6", this->Sigmas), "Give 3");
    pv::need_length(this->Distance, "Distance");
    if (this->Neighbourhood < -1 || this->Neighbourhood > 100)
      throw UsageError("Neighbourhood", fmt::format("{} is not in -1 to 100", this->Neighbourhood),
                       "Give -1");
    std::string name;
    const HeightField field = this->Heights(inputs, name);
    vtkImageData* const tip_image = pv::image_input(inputs, 1, "Tip");
    const Tip tip = pv::to_tip_for(tip_image, pv::chosen_array(this, 1, tip_image), field, "Tip");
    if (!tip.doubt.empty()) pv::warn(this, fmt::format("the tip says that it is not to be trusted: {}", tip.doubt));
    CertaintyMap map;
    pv::work(this, [&](const Watch& watch) {
      map = certainty_map(field, tip,
                          {.noise_nm = this->Noise < 0 ? pixel_noise_nm(field) : this->Noise,
                           .sigmas = this->Sigmas,
                           .neighbourhood = this->Neighbourhood,
                           .distance_nm = this->Distance,
                           .watch = watch});
    });
    if (20 * map.unexplained > map.image_pixels)
      pv::warn(this,
               fmt::format(
                   "{:.0f} % of the scan cannot have been made by this tip with this noise: the tip may be "
                   "sharper than it is said to be, or Noise larger",
                   100.0 * static_cast<double>(map.unexplained) / static_cast<double>(map.image_pixels)));
    const auto image = this->WithHeights(inputs, std::move(map.surface), name);
    add_map(image, map.level);
    pv::give(outputs->GetInformationObject(0), image);
  });
}
