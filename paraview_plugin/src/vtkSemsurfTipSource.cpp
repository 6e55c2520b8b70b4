// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfTipSource.h"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/tip.h"
#include "pipeline.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/io/scan_parameters.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/tip_job.h"

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
    if (this->Shape < Cone || this->Shape > Ball)
      throw UsageError("Shape", fmt::format("there is no shape {}", this->Shape), "Choose 0 to 3");
    if (this->Shape == Pyramid) pv::need_within(this->Faces, 3, 100, "Faces");
    workflow::TipShapeParameters parameters;
    parameters.shape = {static_cast<workflow::TipShape::Kind>(this->Shape), this->Radius, this->HalfAngle, this->Faces,
                        this->Rotation, this->StemRadius, this->StemRadius > 0 ? this->StemHalfAngle : 0};
    parameters.size = this->Samples;
    parameters.pitch_x_nm = parameters.pitch_y_nm = this->Pitch;
    const auto image = pv::to_vtk(workflow::tip_by_shape(parameters));
    io::HeightReadOptions reading;
    reading.pitch_x_nm = reading.pitch_y_nm = this->Pitch;
    pv::add_record(image, "tip", workflow::records_of(parameters, reading));
    pv::give(outputs->GetInformationObject(0), image);
  });
}
