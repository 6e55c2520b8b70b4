// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfTipSource.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/tip.h"
#include "pipeline.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

vtkStandardNewMacro(vtkSemsurfTipSource);

using namespace surf;

void vtkSemsurfTipSource::Check() const {
  if (this->Samples < 3 || this->Samples > 4001 || this->Samples % 2 == 0)
    throw UsageError("Samples",
                     fmt::format("{} is no odd number from 3 to 4001, so that there is no middle for the "
                                 "apex",
                                 this->Samples),
                     "Give 41 where in doubt");
  pv::need_positive(this->Pitch, "Pitch");
  pv::need_positive(this->Radius, "Radius");
  pv::need_number(this->Rotation, "Rotation");
  pv::need_length(this->StemRadius, "Stem Radius");
  const auto need_angle = [](double deg, const char* label) {
    if (!(deg >= 0 && deg < 90)) throw UsageError(label, fmt::format("{} degrees are not in 0 to 90", deg), "Give 15, say");
  };
  need_angle(this->HalfAngle, "Half Angle");
  need_angle(this->StemHalfAngle, "Stem Half Angle");
}

int vtkSemsurfTipSource::RequestInformation(vtkInformation*, vtkInformationVector**,
                                            vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    this->Check();
    const double corner = -(this->Samples / 2) * this->Pitch;
    pv::announce(outputs->GetInformationObject(0),
                 {this->Samples, this->Samples, this->Pitch, this->Pitch, corner, corner});
  });
}

int vtkSemsurfTipSource::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    this->Check();
    const TipSampling sampling{this->Pitch, this->Pitch, this->Samples, this->Samples};
    const double half_angle = this->HalfAngle * degrees_to_radians;
    Tip tip;
    switch (this->Shape) {
      case Cone: tip = conical_tip(this->Radius, half_angle, sampling); break;
      case Parabola: tip = parabolic_tip(this->Radius, sampling); break;
      case Pyramid: {
        if (this->Faces < 3 || this->Faces > 100)
          throw UsageError("Faces", fmt::format("{} is not in 3 to 100", this->Faces),
                           "Give 4 where in doubt");
        PyramidShape shape;
        shape.radius_nm = this->Radius;
        shape.rotation_rad = this->Rotation * degrees_to_radians;
        shape.face_angles_rad.assign(static_cast<std::size_t>(this->Faces), half_angle);
        tip = pyramidal_tip(shape, sampling);
        break;
      }
      case Ball:
        // On a cylinder, which is never seen, any radius does.
        tip = ball_tip(this->Radius, this->StemRadius > 0 ? this->StemRadius : 0.5 * this->Radius,
                       this->StemRadius > 0 ? this->StemHalfAngle * degrees_to_radians : 0, sampling);
        break;
      default: throw UsageError("Shape", fmt::format("there is no shape {}", this->Shape), "Choose 0 to 3");
    }
    pv::give(outputs->GetInformationObject(0), pv::to_vtk(tip));
  });
}
