// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfRegister.h"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include <cmath>
#include <optional>
#include <utility>

#include "attempt.h"
#include "chain.h"
#include "convert/table.h"
#include "convert/tip.h"
#include "convert/transform.h"
#include "labels.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/core/error.h"
#include "surf/core/sample_image.h"
#include "surf/core/units.h"

vtkStandardNewMacro(vtkSemsurfRegister);

using namespace surf;

namespace {

/// An image on the scan's samples, NaN beyond it.
Grid<double> on_scan(const PlacedImage& image, const Affine& from_scan, const pv::Frame& f) {
  Grid<double> values(f.width, f.height);
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x)
      values(x, y) = sample_image(
          image, from_scan({f.origin_x_nm + x * f.pitch_x_nm, f.origin_y_nm + y * f.pitch_y_nm}));
  return values;
}

/// Half of each, with mean 0 and standard deviation 1 where both are.
Grid<double> blended(const Grid<double>& a, const Grid<double>& b) {
  double n = 0, sums[2] = {0, 0}, squares[2] = {0, 0};
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double v[2] = {a.data()[i], b.data()[i]};
    if (!std::isfinite(v[0] + v[1])) continue;
    ++n;
    for (int k = 0; k < 2; ++k) sums[k] += v[k], squares[k] += v[k] * v[k];
  }
  const auto mean = [&](int k) { return n > 0 ? sums[k] / n : 0; };
  const auto deviation = [&](int k) {
    const double variance = n > 0 ? squares[k] / n - mean(k) * mean(k) : 0;
    return variance > 0 ? std::sqrt(variance) : 1;
  };
  Grid<double> both(a.width(), a.height());
  for (std::size_t i = 0; i < a.size(); ++i)
    both.data()[i] =
        0.5 * ((a.data()[i] - mean(0)) / deviation(0) + (b.data()[i] - mean(1)) / deviation(1));
  return both;
}

void fill_table(vtkTable* table, const workflow::Pose& pose) {
  const Affine& m = pose.sem_to_afm;
  const AffineParts p = parts_of(m);
  std::vector<pv::Quantity> q{{"xx", m.xx},
                              {"xy", m.xy},
                              {"x0_nm", m.x0},
                              {"yx", m.yx},
                              {"yy", m.yy},
                              {"y0_nm", m.y0},
                              {"rotation_deg", p.rotation_rad / degrees_to_radians},
                              {"scale_x", p.scale_x},
                              {"scale_y", p.scale_y},
                              {"shear", p.shear},
                              {"verified", pose.verified() ? 1.0 : 0.0}};
  if (pose.landmarks) q.push_back({"landmarks_rms_nm", pose.landmarks->rms_nm});
  if (const auto& r = pose.registration)
    q.insert(q.end(), {{"score", r->score}, {"stderr_px", r->stderr_px}, {"overlap", r->overlap}});
  pv::add_quantities(table, q);
}

}  // namespace

int vtkSemsurfRegister::FillInputPortInformation(int port, vtkInformation* info) {
  const bool points = port == 2 || port == 3;
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), points ? "vtkPolyData" : "vtkImageData");
  if (port > 1) info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkSemsurfRegister::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

int vtkSemsurfRegister::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                    vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::with_labels(
        [&] {
          workflow::RegisterJob job;
          this->Values->apply(job);
          pv::complete(job.model, *this->Values);
          std::string name;
          job.afm.scan = this->Heights(inputs, name);
          vtkImageData* const sem = pv::image_input(inputs, 1, "SEM");
          job.sem.image = pv::to_placed_image(sem, pv::chosen_array(this, 1, sem), "SEM");
          if (vtkImageData* const tip = pv::image_input(inputs, 4, "Tip"))
            job.afm.preparation.tip = pv::to_tip(tip, pv::chosen_array(this, 2, tip), "Tip");
          job.pose.landmarks =
              pv::landmarks_of(pv::surface_input(inputs, 3), pv::surface_input(inputs, 2));
          if (job.pose.landmarks_only && job.pose.landmarks.empty())
            throw UsageError("`registration.landmarks_only`", "there are no landmarks",
                             "Give three pairs or more");
          std::vector<std::string> warnings;
          std::optional<workflow::RegisterSummary> s;
          pv::work(this, [&](const Watch& watch) {
            s = workflow::run(job, pv::listen(watch, 3, warnings));
          });
          if (s->pose.registration && !s->pose.verified())
            warnings.push_back(fmt::format("the registration is {}: {}",
                                           workflow::name(s->pose.registration->verdict),
                                           s->pose.registration->reason));
          for (const std::string& warning : warnings) pv::warn(this, warning);
          const Affine back = inverse(s->pose.sem_to_afm);
          vtkImageData* const scan = pv::image_input(inputs, 0, "Input");
          const pv::Frame frame = pv::frame_of(scan, "Input");
          auto image = pv::make_image_like(scan);
          Grid<double> seen = on_scan(job.sem.image, back, frame),
                       simulated = on_scan(s->pose.simulated, Affine{}, frame);
          pv::add_values(image, blended(seen, simulated), "blend", "1");
          pv::add_values(image, std::move(seen), "sem", "1");
          pv::add_values(image, std::move(simulated), "simulated", "1");
          pv::add_heights(image, s->afm.eroded());
          image->GetPointData()->SetActiveScalars("blend");
          const auto& r = s->pose.registration;
          const std::map<std::string, std::string> texts{
              {pv::transform_text, pv::text_of(s->pose.sem_to_afm)},
              {"verdict", r ? workflow::name(r->verdict) : "by landmarks"}};
          pv::add_texts(image, texts);
          pv::add_chain_record(image, "register", record_of(job), &s->model);
          vtkNew<vtkTable> table;
          fill_table(table, s->pose);
          pv::add_texts(table, texts);
          pv::give(outputs->GetInformationObject(0), image);
          pv::give(outputs->GetInformationObject(1), table);
        },
        pv::chain_labels);
  });
}
