// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfLevel.h"

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
#include "surf/workflow/level_job.h"

vtkStandardNewMacro(vtkSemsurfLevel);

using namespace surf;

int vtkSemsurfLevel::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                 vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    if (this->Method < Hough || this->Method > None)
      throw UsageError("Method", fmt::format("there is no method {}", this->Method), "Choose 0 to 3");
    if (this->Rows < Keep || this->Rows > Difference)
      throw UsageError("Rows", fmt::format("there is no method {}", this->Rows), "Choose 0 to 2");
    workflow::LevelParameters parameters;
    parameters.method = static_cast<workflow::LevelMethod>(this->Method);
    if (this->Method == Hough) {
      pv::need_length(this->Tolerance, "Tolerance");
      if (this->Tolerance > 0) parameters.tolerance_nm = this->Tolerance;
    }
    if (this->Method == Polynomial) {
      pv::need_within(this->Degree, 0, 6, "Degree");
      parameters.degree = this->Degree;
    }
    if (this->Rows != Keep) parameters.rows = static_cast<RowMethod>(this->Rows - 1);
    std::string name;
    const HeightField scan = this->Heights(inputs, name);
    std::vector<std::string> warnings;
    workflow::LevelResult levelled;
    pv::work(this,
             [&](const Watch& watch) { levelled = workflow::level(scan, parameters, {}, pv::hear(watch, warnings)); });
    pv::warn(this, warnings);
    const auto image = this->WithHeights(inputs, std::move(levelled.field), name);
    if (levelled.hough) pv::add_values(image, std::move(levelled.substrate), "substrate", "1");
    pv::add_record(image, "level", record_of(parameters));
    pv::give(outputs->GetInformationObject(0), image);
  });
}
