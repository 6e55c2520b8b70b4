// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "labels.h"
#include "surf/core/progress.h"
#include "surf/mc/physics/material.h"
#include "surf/registration/landmarks.h"
#include "surf/workflow/register_job.h"

class vtkDataObject;
class vtkPolyData;

namespace surf::pv {

class PropertyValues;

/// What a job's description cannot take from properties: the folder that models are kept in and,
/// where no model is named, the material. Throws UsageError.
void complete(workflow::ModelRequest& request, const PropertyValues& values);

/// The material that properties name; without a name where they name none. Throws UsageError.
mc::Material chosen_material(const PropertyValues& values);

/// What properties of both filters are called that are not called as their fields are.
extern const Labels chain_labels;

/// Says with the data how they were made: the job's parameters, and which model of which hash it
/// was.
void add_chain_record(vtkDataObject* data, const std::string& step, const Record& parameters,
                      const workflow::StoredModel* model);

/// Points that were picked in both views, in the same order; either may be nullptr. Throws
/// UsageError where there are not as many of both.
std::vector<LandmarkPair> landmarks_of(vtkPolyData* sem, vtkPolyData* afm);

/// Tells a watch of a chain's stages, of which there are about `stages`, and collects the warnings.
workflow::Reporter listen(const Watch& watch, int stages, std::vector<std::string>& warnings);

}  // namespace surf::pv
