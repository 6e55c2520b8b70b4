// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfCalibrate.h"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkTable.h>

#include <cmath>
#include <limits>
#include <utility>

#include "attempt.h"
#include "checks.h"
#include "convert/table.h"
#include "labels.h"
#include "pipeline.h"
#include "surf/core/error.h"
#include "surf/io/calibration_file.h"
#include "surf/sem/calibration.h"

vtkStandardNewMacro(vtkSemsurfCalibrate);

using namespace surf;

namespace {

std::vector<std::string> channels_of(const std::string& wish, vtkImageData* image, vtkDataArray* shown) {
  std::vector<std::string> names;
  for (std::size_t from = 0; from < wish.size();) {
    const std::size_t end = std::min(wish.find(',', from), wish.size());
    const std::size_t first = wish.find_first_not_of(' ', from);
    if (first < end) names.push_back(wish.substr(first, wish.find_last_not_of(' ', end - 1) + 1 - first));
    from = end + 1;
  }
  if (names.empty())
    for (const char* usual : {"SE", "BSE"})
      if (image->GetPointData()->GetArray(usual)) names.emplace_back(usual);
  if (names.empty() && shown && shown->GetName()) names.emplace_back(shown->GetName());
  return names;
}

}  // namespace

int vtkSemsurfCalibrate::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

int vtkSemsurfCalibrate::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::with_labels([&] {
      vtkImageData* const real_image = pv::image_input(inputs, 0, "Input");
      vtkImageData* const model_image = pv::image_input(inputs, 1, "Simulated");
      PlacedImage real = pv::to_placed_image(real_image, pv::chosen_array(this, 0, real_image), "Input");
      CalibrationImages images;
      images.used = std::move(real.valid);
      for (const std::string& name : channels_of(this->Channels, model_image, pv::chosen_array(this, 1, model_image))) {
        vtkDataArray* const array = model_image->GetPointData()->GetArray(name.c_str());
        if (!array) throw UsageError("Channels", fmt::format("Simulated has no array '{}'", name), "Name those that it has");
        const PlacedImage one = pv::to_placed_image(model_image, array, "Simulated");
        const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-3 * std::max(a, b); };
        if (one.values.width() != real.values.width() || one.values.height() != real.values.height() ||
            differ(one.pitch_x_nm, real.pitch_x_nm) || differ(one.pitch_y_nm, real.pitch_y_nm))
          throw InvalidInput("Simulated",
                             fmt::format("its {} x {} pixels of {:.4g} nm are not the {} x {} of {:.4g} nm of the image",
                                         one.values.width(), one.values.height(), one.pitch_x_nm, real.values.width(),
                                         real.values.height(), real.pitch_x_nm),
                             "Simulate or predict it on the same pixels");
        images.channels.push_back(name);
        images.simulated.push_back(one.values);
      }
      images.real = std::move(real.values);
      CalibrationOptions options;
      pv::need_moderate(this->Offset, "Offset");
      pv::need_moderate(this->Black, "Black");
      pv::need_moderate(this->White, "White");
      if (this->Saturation && this->Black >= this->White)
        throw UsageError("White", fmt::format("{} is not above Black, {}", this->White, this->Black), "Give 255, say");
      if (this->FixOffset) options.offset = this->Offset;
      if (this->Saturation) options.black = this->Black, options.white = this->White;
      Calibration c;
      pv::work(this, [&](const Watch&) { c = calibrate(images, options); });
      for (const std::string& warning : c.warnings) pv::warn(this, warning);

      std::vector<pv::Quantity> q;
      for (std::size_t i = 0; i < c.channels.size(); ++i) {
        q.push_back({"gain " + c.channels[i], c.gains[i]});
        q.push_back({"gain " + c.channels[i] + " stderr", c.gain_stderr(i)});
      }
      q.insert(q.end(), {{"offset", c.offset}, {"offset stderr", c.offset_stderr()}, {"condition", c.condition_number},
                         {"residual_rms", c.residual_rms}, {"explained", c.explained},
                         {"residual_correlation", c.residual_correlation}, {"pixels", double(c.pixels)},
                         {"saturated", double(c.saturated)}});
      vtkNew<vtkTable> table;
      pv::add_quantities(table, q);
      pv::add_texts(table, {{"outcome", io::name(c.outcome)}});
      Grid<double> fit = calibrated_image(c, images.simulated), residual(fit.width(), fit.height());
      for (std::size_t i = 0; i < fit.size(); ++i) {
        const bool known = images.used.empty() || images.used.data()[i];
        residual.data()[i] = known ? images.real.data()[i] - fit.data()[i] : std::numeric_limits<double>::quiet_NaN();
      }
      const auto image = pv::make_image_like(real_image);
      pv::add_values(image, std::move(fit), "calibrated", "1");
      pv::add_values(image, std::move(residual), "residual", "1");
      image->GetPointData()->SetActiveScalars("calibrated");
      pv::give(outputs->GetInformationObject(0), image);
      pv::give(outputs->GetInformationObject(1), table);
    });
  });
}
