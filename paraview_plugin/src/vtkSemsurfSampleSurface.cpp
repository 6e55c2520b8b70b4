// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfSampleSurface.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "labels.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

vtkStandardNewMacro(vtkSemsurfSampleSurface);

namespace {

using namespace surf;

int samples_along(double length_nm, double pitch_nm, const char* property) {
  constexpr double most = 16384;
  const double count = std::round(length_nm / pitch_nm) + 1;
  if (pitch_nm > 0 && count >= 2 && count <= most) return static_cast<int>(count);
  throw UsageError(
      property,
      fmt::format("{} nm at a Pitch of {} nm are no 2 to {} samples", length_nm, pitch_nm, most),
      "Change it, or Pitch");
}

pv::Frame frame_of(const FieldExtent& extent) {
  const int width = samples_along(extent.width_nm, extent.pitch_nm, "Width");
  const int height = samples_along(extent.depth_nm, extent.pitch_nm, "Depth");
  return {{extent.pitch_nm, extent.pitch_nm, -0.5 * (width - 1) * extent.pitch_nm,
           -0.5 * (height - 1) * extent.pitch_nm},
          width,
          height};
}

}  // namespace

int vtkSemsurfSampleSurface::RequestInformation(vtkInformation*, vtkInformationVector**,
                                                vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    pv::announce(outputs->GetInformationObject(0),
                 frame_of({this->Width, this->Depth, this->Pitch}));
  });
}

HeightField vtkSemsurfSampleSurface::Make(const FieldExtent& extent) const {
  const auto seed = static_cast<std::uint64_t>(this->Seed);
  switch (this->Shape) {
    case Mesa:
      return make_mesa(extent, this->FeatureHeight, this->FeatureWidth, this->WallRun);
    case Trench:
      return make_trench(extent, this->FeatureHeight, this->FeatureWidth, this->WallRun);
    case Line:
      return make_line(extent, this->FeatureHeight, this->FeatureWidth, this->WallRun);
    case Via:
      return make_via(extent, this->FeatureHeight, this->FeatureWidth, this->WallRun);
    case Step:
      return make_step(extent, this->FeatureHeight, this->WallRun);
    case Grating:
      return make_grating(extent, this->FeatureHeight, this->Period, this->FeatureWidth,
                          this->WallRun);
    case Rough:
      return make_rough(extent, this->RmsHeight, this->CorrelationLength, seed);
    case SelfAffine:
      return make_self_affine(extent, this->RmsHeight, this->CorrelationLength, this->HurstExponent,
                              seed);
    default:
      throw UsageError("Shape", fmt::format("there is no shape {}", this->Shape), "Choose 0 to 7");
  }
}

int vtkSemsurfSampleSurface::RequestData(vtkInformation*, vtkInformationVector**,
                                         vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    const FieldExtent extent{this->Width, this->Depth, this->Pitch};
    frame_of(extent);  // complains of what cannot be sampled
    if (this->Shape <= Grating) {
      pv::need_length(this->FeatureWidth, "Feature Width");
      pv::need_length(this->WallRun, "Wall Run");
    }
    HeightField field;
    pv::with_labels([&] { pv::work(this, [&](const Watch&) { field = this->Make(extent); }); },
                    {{"height of", "Feature Height"},
                     {"depth of", "Feature Height"},
                     {"top width", "Feature Width"},
                     {"bottom width", "Feature Width"},
                     {"wall run", "Wall Run"},
                     {"period", "Period"},
                     {"rms height", "Rms Height"},
                     {"correlation length", "Correlation Length"},
                     {"Hurst exponent", "Hurst Exponent"}});
    pv::give(outputs->GetInformationObject(0), pv::to_vtk(std::move(field)));
  });
}
