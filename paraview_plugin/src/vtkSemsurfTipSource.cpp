// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfTipSource.h"

#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include "attempt.h"
#include "checks.h"
#include "convert/tip.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/io/scan_parameters.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/tip_job.h"

vtkStandardNewMacro(vtkSemsurfTipSource);

using namespace surf;

vtkSemsurfTipSource::vtkSemsurfTipSource() : Values(std::make_unique<pv::PropertyValues>()) {
  this->SetNumberOfInputPorts(0);
}
vtkSemsurfTipSource::~vtkSemsurfTipSource() = default;

void vtkSemsurfTipSource::SetParameter(const char* name, double value) {
  if (this->Values->set(name, value)) this->Modified();
}

workflow::TipShapeParameters vtkSemsurfTipSource::Parameters() const {
  pv::need_positive(this->Pitch, "Pitch");
  workflow::TipShapeParameters parameters;
  this->Values->apply(parameters);
  this->Values->apply(parameters.shape);
  if (parameters.shape.stem_radius_nm == 0) parameters.shape.stem_half_angle_deg = 0;
  parameters.pitch_x_nm = parameters.pitch_y_nm = this->Pitch;
  return parameters;
}

int vtkSemsurfTipSource::RequestInformation(vtkInformation*, vtkInformationVector**,
                                            vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    const int samples = this->Parameters().size;
    const double corner = -(samples / 2) * this->Pitch;
    pv::announce(outputs->GetInformationObject(0),
                 {{this->Pitch, this->Pitch, corner, corner}, samples, samples});
  });
}

int vtkSemsurfTipSource::RequestData(vtkInformation*, vtkInformationVector**,
                                     vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    const workflow::TipShapeParameters parameters = this->Parameters();
    const auto image = pv::to_vtk(workflow::tip_by_shape(parameters));
    io::HeightReadOptions reading;
    reading.pitch_x_nm = reading.pitch_y_nm = this->Pitch;
    pv::add_record(image, "tip", workflow::records_of(parameters, reading));
    pv::give(outputs->GetInformationObject(0), image);
  });
}
