// SPDX-License-Identifier: GPL-3.0-or-later
#include "chain.h"

#include <fmt/format.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "convert/image.h"
#include "property_values.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/io/cache.h"
#include "surf/io/sim/materials.h"

namespace surf::pv {

const Labels chain_labels{{"`specimen.material`", "Material"},
                          {"`level.method`", "Level Method"},
                          {"`level.degree`", "Level Degree"},
                          {"`level.tolerance`", "Level Tolerance"}};

void complete(workflow::ModelRequest& request, const PropertyValues& values) {
  const std::filesystem::path cache = io::cache_folder();
  if (!cache.empty()) request.folder = cache / "models";
  if (!request.file.empty()) return;
  mc::Material material = chosen_material(values);
  if (material.name.empty())
    throw UsageError("`reconstruction.model`", "no model is named, nor a material",
                     "Give one of the two");
  if (cache.empty())
    throw UsageError("`reconstruction.model`",
                     "none is named, and there is no cache to keep one in", "Name one");
  request.material = std::move(material);
}

mc::Material chosen_material(const PropertyValues& values) {
  io::MaterialChoice choice;
  values.apply(choice);
  if (choice.name.empty()) return {};
  std::vector<std::string> notes;
  return io::find_material(choice, notes);
}

void add_chain_record(vtkDataObject* data, const std::string& step, const Record& parameters,
                      const workflow::StoredModel* model) {
  add_record(data, step, parameters);
  if (model)
    add_texts(
        data,
        {{"model", fmt::format("{} sha256 {}", model->file.filename().string(), model->sha256)}});
}

std::vector<LandmarkPair> landmarks_of(vtkPolyData* sem, vtkPolyData* afm) {
  const vtkIdType of_sem = sem ? sem->GetNumberOfPoints() : 0,
                  of_afm = afm ? afm->GetNumberOfPoints() : 0;
  if (of_sem != of_afm)
    throw UsageError("SEM Landmarks",
                     fmt::format("there are {}, and {} AFM Landmarks", of_sem, of_afm),
                     "Give the same places in both, in the same order, or none");
  std::vector<LandmarkPair> pairs;
  for (vtkIdType i = 0; i < of_sem; ++i) {
    double s[3], a[3];
    sem->GetPoint(i, s);
    afm->GetPoint(i, a);
    pairs.push_back({{s[0], s[1]}, {a[0], a[1]}});
  }
  if (!pairs.empty()) fit_landmarks(pairs);  // complains of too few, or on a line, before any work
  return pairs;
}

workflow::Reporter listen(const Watch& watch, int stages, std::vector<std::string>& warnings) {
  workflow::Reporter listener;
  const auto begun = std::make_shared<int>(0);
  const auto tell = [watch, stages, begun](double share) {
    if (watch.progress) watch.progress(std::min(*begun - 1 + share, double(stages)), stages);
  };
  listener.on_stage = [begun, tell](const std::string&) {
    ++*begun;
    tell(0);
  };
  listener.on_progress = [tell](double done, double total, std::string_view) {
    tell(total > 0 ? std::clamp(done / total, 0.0, 1.0) : 0);
  };
  listener.on_warning = [&warnings](const std::string& text) { warnings.push_back(text); };
  listener.cancel = watch.cancel;
  return listener;
}

}  // namespace surf::pv
