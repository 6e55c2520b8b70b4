// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports.h"

#include "attempt.h"
#include "convert/image.h"
#include "surf/workflow/step_record.h"

namespace surf::pv {

workflow::Reporter hear(const Watch& watch, std::vector<std::string>& warnings) {
  workflow::Reporter reporter;
  reporter.on_progress = [watch](double done, double total, std::string_view) {
    if (watch.progress) watch.progress(done, total);
  };
  reporter.on_warning = [&warnings](const std::string& text) { warnings.push_back(text); };
  reporter.cancel = watch.cancel;
  return reporter;
}

void warn(vtkAlgorithm* self, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) warn(self, warning);
}

void add_record(vtkDataObject* data, const std::string& step, const Record& parameters) {
  add_texts(data, workflow::step_record(step, parameters));
}

}  // namespace surf::pv
