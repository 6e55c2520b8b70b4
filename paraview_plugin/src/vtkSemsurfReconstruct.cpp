// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfReconstruct.h"

#include <fmt/format.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>

#include <optional>
#include <utility>

#include "attempt.h"
#include "chain.h"
#include "convert/mesh.h"
#include "convert/table.h"
#include "convert/tip.h"
#include "convert/transform.h"
#include "labels.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/workflow/reconstruct_job.h"

vtkStandardNewMacro(vtkSemsurfReconstruct);

using namespace surf;

namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

void announce_like(vtkInformation* output, vtkInformation* input) {
  for (auto* const key : {Pipeline::WHOLE_EXTENT()}) output->CopyEntry(input, key);
  for (auto* const key : {vtkDataObject::SPACING(), vtkDataObject::ORIGIN()})
    output->CopyEntry(input, key);
  output->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
}

Surface surface_of(const Reconstruction& r) {
  Surface surface;
  surface.name = "reconstruction";
  surface.mesh = height_field_sheet(r.surface);
  const auto add = [&](const char* name, const char* unit, const auto& grid) {
    VertexScalar scalar{name, unit, {}};
    for (const auto value : grid.data()) scalar.values.push_back(static_cast<float>(value));
    surface.scalars.push_back(std::move(scalar));
  };
  add("height", "nm", r.surface.z_nm);
  if (!r.deviation_nm.empty()) add("deviation", "nm", r.deviation_nm);
  if (!r.data_support.empty()) add("data_support", "1", r.data_support);
  return surface;
}

void fill_history(vtkTable* table, const std::vector<ScaleReport>& scales) {
  const auto add = [&](const char* name, auto value) {
    std::vector<double> column;
    for (const ScaleReport& s : scales) column.push_back(static_cast<double>(value(s)));
    pv::add_column(table, name, std::move(column));
  };
  add("sigma_px", [](const ScaleReport& s) { return s.sigma_px; });
  add("afm", [](const ScaleReport& s) { return s.afm; });
  add("sem", [](const ScaleReport& s) { return s.sem; });
  add("prior", [](const ScaleReport& s) { return s.prior; });
  add("gradient_norm", [](const ScaleReport& s) { return s.gradient_norm; });
  add("iterations", [](const ScaleReport& s) { return s.iterations; });
  add("evaluations", [](const ScaleReport& s) { return s.evaluations; });
  add("products", [](const ScaleReport& s) { return s.products; });
  add("afm_deviation", [](const ScaleReport& s) { return s.afm_residual.deviation; });
  add("sem_deviation", [](const ScaleReport& s) { return s.sem_residual.deviation; });
  std::vector<std::string> ended;
  for (const ScaleReport& s : scales) ended.push_back(s.ended);
  pv::add_column(table, "ended", ended);
}

/// What further SEM images are compared with, one block each.
vtkSmartPointer<vtkMultiBlockDataSet> views_of(vtkInformationVector** inputs,
                                               std::vector<ViewResult>& views) {
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (std::size_t k = 0; k < views.size(); ++k) {
    const auto number = static_cast<unsigned>(k);
    const auto image =
        pv::make_image_like(pv::image_input(inputs, 1, "SEM", static_cast<int>(k) + 1));
    ViewResult& view = views[k];
    pv::add_values(image, std::move(view.residual), "residual", "1");
    pv::add_values(image, std::move(view.simulated), "simulated", "1");
    pv::add_values(image, std::move(view.used), "used", "1");
    image->GetPointData()->SetActiveScalars("residual");
    blocks->SetBlock(number, image);
    const std::string name = fmt::format("view {}, tilted by {:.2f} deg to {:.0f} deg", k + 2,
                                         view.pose.tilt_deg, view.pose.azimuth_deg);
    blocks->GetMetaData(number)->Set(vtkCompositeDataSet::NAME(), name.c_str());
  }
  return blocks;
}

}  // namespace

int vtkSemsurfReconstruct::FillInputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port > 2 ? "vtkPolyData" : "vtkImageData");
  if (port > 0) info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  if (port == 1) info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  return 1;
}

int vtkSemsurfReconstruct::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 1   ? "vtkPolyData"
                                             : port == 4 ? "vtkTable"
                                             : port == 5 ? "vtkMultiBlockDataSet"
                                                         : "vtkImageData");
  return 1;
}

/// The surface and the SEM's residual lie on the SEM's pixels, the scan's on its own.
int vtkSemsurfReconstruct::RequestInformation(vtkInformation*, vtkInformationVector** inputs,
                                              vtkInformationVector* outputs) {
  vtkInformation* const afm = inputs[0]->GetInformationObject(0);
  vtkInformation* const sem =
      inputs[1]->GetNumberOfInformationObjects() > 0 ? inputs[1]->GetInformationObject(0) : afm;
  announce_like(outputs->GetInformationObject(0), sem);
  announce_like(outputs->GetInformationObject(2), afm);
  announce_like(outputs->GetInformationObject(3), sem);
  return 1;
}

int vtkSemsurfReconstruct::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                       vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::with_labels(
        [&] {
          vtkImageData* const sem = pv::image_input(inputs, 1, "SEM");
          workflow::ReconstructJob job;
          job.picture = false;
          job.afm.emplace();
          if (sem) job.sem.emplace();
          pv::PropertyValues values = *this->Values;
          if (!this->UseTransform) values.forget("registration.transform");
          values.apply(job);
          std::string name;
          job.afm->scan = this->Heights(inputs, name);
          if (vtkImageData* const tip = pv::image_input(inputs, 2, "Tip"))
            job.afm->preparation.tip = pv::to_tip(tip, pv::chosen_array(this, 2, tip), "Tip");
          if (sem) {
            pv::complete(job.model, values);
            job.sem->image = pv::to_placed_image(sem, pv::chosen_array(this, 1, sem), "SEM");
            for (int k = 1; vtkImageData* const view = pv::image_input(inputs, 1, "SEM", k); ++k) {
              job.views.emplace_back();
              job.views.back().image =
                  pv::to_placed_image(view, pv::chosen_array(this, 1, view), "SEM");
            }
            job.pose.landmarks =
                pv::landmarks_of(pv::surface_input(inputs, 4), pv::surface_input(inputs, 3));
          }
          std::vector<std::string> warnings;
          std::optional<workflow::ReconstructSummary> s;
          pv::work(this, [&](const Watch& watch) {
            s = workflow::run(job, pv::listen(watch, job.sem ? 5 : 2, warnings));
          });
          for (const std::string& warning : warnings) pv::warn(this, warning);
          if (s->verdict == workflow::ReconstructionVerdict::not_registered)
            throw InvalidInput("SEM", s->reasons.at(0),
                               "Give landmarks, Use Transform, or Accept Registration");
          for (const std::string& reason : s->reasons) pv::warn(this, reason);
          Reconstruction& r = s->result;
          const std::map<std::string, std::string> texts{
              {"verdict", workflow::name(s->verdict)},
              {pv::transform_text, pv::text_of(r.sem_to_afm)}};
          pv::give(outputs->GetInformationObject(1), pv::to_vtk(surface_of(r)));
          vtkNew<vtkTable> history;
          fill_history(history, r.scales);
          pv::give(outputs->GetInformationObject(4), history);
          vtkMultiBlockDataSet::GetData(outputs->GetInformationObject(5))
              ->ShallowCopy(views_of(inputs, r.views));
          // Like the inputs, so that pieces of them are the pieces that were announced.
          const auto afm = pv::make_image_like(pv::image_input(inputs, 0, "Input"));
          const auto surface = pv::make_image_like(pv::image_input(inputs, job.sem ? 1 : 0, "SEM"));
          if (!r.afm_residual.empty()) {
            pv::add_values(afm, std::move(r.afm_residual), "residual", "1");
            pv::add_values(afm, std::move(r.afm_used), "used", "1");
            pv::add_heights(afm, std::move(r.simulated_afm), "simulated_nm");
            afm->GetPointData()->SetActiveScalars("residual");
          }
          if (!r.sem_residual.empty()) {
            const auto compared = pv::make_image_like(surface);
            pv::add_values(compared, std::move(r.sem_residual), "residual", "1");
            if (!r.sem_discrepancy.empty())
              pv::add_values(compared, std::move(r.sem_discrepancy), "discrepancy", "1");
            pv::add_values(compared, std::move(r.simulated_sem), "simulated", "1");
            compared->GetPointData()->SetActiveScalars("residual");
            pv::give(outputs->GetInformationObject(3), compared);
          }
          if (!r.deviation_nm.empty())
            pv::add_values(surface, std::move(r.deviation_nm), "deviation_nm", "nm");
          if (!r.lower_nm.empty()) {
            pv::add_values(surface, std::move(r.lower_nm), "lower_nm", "nm");
            pv::add_values(surface, std::move(r.upper_nm), "upper_nm", "nm");
          }
          if (!r.data_support.empty())
            pv::add_values(surface, std::move(r.data_support), "data_support", "1");
          if (r.start.z_nm.size() == r.surface.z_nm.size())
            pv::add_values(surface, std::move(r.start.z_nm), "start_nm", "nm");
          pv::add_heights(surface, std::move(r.surface));
          pv::add_texts(surface, texts);
          pv::add_chain_record(surface, "reconstruct", record_of(job),
                               s->model ? &*s->model : nullptr);
          pv::give(outputs->GetInformationObject(0), surface);
          pv::give(outputs->GetInformationObject(2), afm);
        },
        pv::chain_labels);
  });
}
