// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfLevel.h"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>

#include <cmath>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "pipeline.h"
#include "surf/afm/hough_plane.h"
#include "surf/afm/row_level.h"
#include "surf/core/error.h"

vtkStandardNewMacro(vtkSemsurfLevel);

using namespace surf;

namespace {

std::string doubt(const HoughSummary& s) {
  if (s.verdict == HoughVerdict::contested)
    return fmt::format(
        "no plane holds a clear majority: another one, {:.3g} nm {} at the centre, holds {:.1f} % of the "
        "image. Crop the image, or choose another Method",
        std::fabs(s.runner_up.height_nm - s.plane.height_nm),
        s.runner_up.height_nm > s.plane.height_nm ? "higher" : "lower", 100 * s.runner_up_share);
  if (s.verdict == HoughVerdict::weak)
    return fmt::format(
        "no plane stands out: the best one holds {:.1f} % of the image, chance alone {:.1f} %. The Method "
        "'Mean plane' may be what is wanted",
        100 * s.inlier_share, 100 * s.chance_share);
  return {};
}

}   // namespace

/// Returns what rows should go by: the substrate, or nothing.
Grid<unsigned char> vtkSemsurfLevel::TakeOff(HeightField& field, const Watch& watch,
                                             std::string& warning) const {
  switch (this->Method) {
    case None: return {};
    case LeastSquares: subtract(field, fit_plane(field)); return {};
    case Polynomial: subtract(field, fit_polynomial(field, this->Degree)); return {};
    case Hough: {
      HoughSummary found = find_plane(field, {this->Tolerance, watch});
      warning = doubt(found);
      subtract(field, found.plane);
      return std::move(found.inliers);
    }
    default: throw UsageError("Method", fmt::format("there is no method {}", this->Method), "Choose 0 to 3");
  }
}

int vtkSemsurfLevel::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                 vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    if (this->Rows < Keep || this->Rows > Difference)
      throw UsageError("Rows", fmt::format("there is no method {}", this->Rows), "Choose 0 to 2");
    if (this->Method == Hough) pv::need_length(this->Tolerance, "Tolerance");
    if (this->Method == Polynomial) pv::need_within(this->Degree, 0, 6, "Degree");
    std::string name, warning;
    HeightField field = this->Heights(inputs, name);
    Grid<unsigned char> substrate;
    pv::work(this, [&](const Watch& watch) {
      substrate = this->TakeOff(field, watch.part(0, this->Rows == Keep ? 1 : 0.5), warning);
      if (this->Rows == Keep) return;
      level_rows(field, this->Rows == Median ? RowMethod::median : RowMethod::difference, substrate);
      substrate = this->TakeOff(field, watch.part(0.5, 1), warning);
    });
    if (!warning.empty()) pv::warn(this, warning);
    const auto image = this->WithHeights(inputs, std::move(field), name);
    if (!substrate.empty()) pv::add_values(image, std::move(substrate), "substrate", "1");
    pv::give(outputs->GetInformationObject(0), image);
  });
}
