// SPDX-License-Identifier: GPL-3.0-or-later
#include "tip_options.h"

#include "bound_parameters.h"
#include "job_reporter.h"
#include "surf/core/error.h"
#include "surf/io/tip_file.h"
#include "surf/workflow/morphology_job.h"

namespace surf::cli {

void add_tip_input(CLI::App& app, std::optional<std::string>& file) {
  with_role(app.add_option("--tip", file, "The tip, as semsurf writes tips or any file of heights")
                ->type_name("FILE"),
            FileRole::read);
}

Tip read_tip_for(const std::optional<std::string>& file, const HeightField& field, bool quiet) {
  if (!file) throw UsageError("--tip", "no tip is given", "Add --tip tip.gsf");
  return workflow::tip_for(io::read_tip(*file), field, *file, JobReporter(quiet));
}

}  // namespace surf::cli
