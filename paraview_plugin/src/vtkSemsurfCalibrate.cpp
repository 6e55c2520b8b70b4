// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfCalibrate.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkTable.h>

#include <limits>
#include <utility>

#include "attempt.h"
#include "convert/image.h"
#include "convert/table.h"
#include "labels.h"
#include "pipeline.h"
#include "property_values.h"
#include "reports.h"
#include "surf/io/model/calibration_file.h"
#include "surf/workflow/calibrate_job.h"

vtkStandardNewMacro(vtkSemsurfCalibrate);

using namespace surf;

int vtkSemsurfCalibrate::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

int vtkSemsurfCalibrate::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                     vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::with_labels([&] {
      workflow::CalibrateParameters parameters;
      this->Values->apply(parameters);
      vtkImageData* const real_image = pv::image_input(inputs, 0, "Input");
      vtkImageData* const model_image = pv::image_input(inputs, 1, "Simulated");
      workflow::CalibrateInput input;
      input.name = "Input", input.simulated_name = "Simulated";
      input.image = pv::to_placed_image(real_image, pv::chosen_array(this, 0, real_image), "Input");
      input.simulated = pv::to_image(model_image, "Simulated");
      vtkDataArray* const shown = pv::chosen_array(this, 1, model_image);
      if (parameters.fit.empty() && !input.simulated.find("SE") && !input.simulated.find("BSE") &&
          shown && shown->GetName())
        parameters.fit = {shown->GetName()};
      std::vector<std::string> warnings;
      workflow::CalibrateResult result;
      pv::work(this, [&](const Watch& watch) {
        result = workflow::calibrate(input, parameters, pv::hear(watch, warnings));
      });
      pv::warn(this, warnings);

      const Calibration& c = result.calibration;
      std::vector<pv::Quantity> q;
      for (std::size_t i = 0; i < c.channels.size(); ++i) {
        q.push_back({"gain " + c.channels[i], c.gains[i]});
        q.push_back({"gain " + c.channels[i] + " stderr", c.gain_stderr(i)});
      }
      q.insert(q.end(), {{"offset", c.offset},
                         {"offset stderr", c.offset_stderr()},
                         {"condition", c.condition_number},
                         {"residual_rms", c.residual_rms},
                         {"explained", c.explained},
                         {"residual_correlation", c.residual_correlation},
                         {"pixels", double(c.pixels)},
                         {"saturated", double(c.saturated)}});
      vtkNew<vtkTable> table;
      pv::add_quantities(table, q);
      pv::add_texts(table, {{"outcome", io::name(c.outcome)}});
      for (std::size_t i = 0; i < result.residual.size(); ++i)
        if (!input.image.valid.empty() && !input.image.valid.data()[i])
          result.residual.data()[i] = std::numeric_limits<double>::quiet_NaN();
      const auto image = pv::make_image_like(real_image);
      pv::add_values(image, std::move(result.fit), "calibrated", "1");
      pv::add_values(image, std::move(result.residual), "residual", "1");
      if (!result.gain.empty()) pv::add_values(image, std::move(result.gain), "gain", "1");
      image->GetPointData()->SetActiveScalars("calibrated");
      pv::add_record(image, "calibrate", record_of(parameters));
      pv::give(outputs->GetInformationObject(0), image);
      pv::give(outputs->GetInformationObject(1), table);
    });
  });
}
