// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfLevel.h"

#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <utility>

#include "attempt.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/workflow/level_job.h"

vtkStandardNewMacro(vtkSemsurfLevel);

using namespace surf;

int vtkSemsurfLevel::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                 vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::PropertyValues values = *this->Values;
    workflow::LevelParameters parameters;
    values.apply(parameters, {"level.method"});
    // What another method has says nothing.
    if (parameters.method != workflow::LevelMethod::hough) values.forget("level.tolerance");
    if (parameters.method != workflow::LevelMethod::polynomial) values.forget("level.degree");
    values.apply(parameters);
    std::string name;
    const HeightField scan = this->Heights(inputs, name);
    std::vector<std::string> warnings;
    workflow::LevelResult levelled;
    pv::work(this, [&](const Watch& watch) {
      levelled = workflow::level(scan, parameters, {}, pv::hear(watch, warnings));
    });
    pv::warn(this, warnings);
    const auto image = this->WithHeights(inputs, std::move(levelled.field), name);
    if (levelled.hough) pv::add_values(image, std::move(levelled.substrate), "substrate", "1");
    pv::add_record(image, "level", record_of(parameters));
    pv::give(outputs->GetInformationObject(0), image);
  });
}
