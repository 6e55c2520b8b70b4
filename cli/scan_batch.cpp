// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan_batch.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <system_error>

#include "afm_options.h"
#include "failure.h"
#include "surf/core/error.h"
#include "surf/io/height_field_file.h"
#include "surf/workflow/survey_job.h"

namespace surf::cli {
namespace {

namespace fs = std::filesystem;

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

}  // namespace

void add_scan_inputs(CLI::App& app, BoundParameters& bound, std::vector<std::string>& scans) {
  with_role(app.add_option("INPUT", scans,
                           "A scan of any format, or an image of heights; or several, or folders "
                           "of them")
                ->type_name("FILE"),
            FileRole::read);
  add_height_reading(app, bound, "Options");
}

std::vector<BatchStep> batch_of(const std::vector<std::string>& scans,
                                const std::optional<std::string>& output,
                                const std::string& command) {
  if (scans.empty()) throw UsageError(command, "no scan is given", "Name a file to read");
  const bool to_folder = output && (output->ends_with('/') || is_folder(*output));
  const bool several = scans.size() > 1 || is_folder(scans.front());
  if (!several && !to_folder) {
    if (output) io::check_height_field_target(*output);
    return {{scans.front(), output, false}};
  }
  const auto files = workflow::scans_of({scans.begin(), scans.end()});
  if (output && !to_folder && fs::path(*output).has_extension() && files.size() > 1)
    throw UsageError("--output", fmt::format("{} scans do not go into one file", files.size()),
                     fmt::format("Name a folder, as -o {}/", fs::path(*output).stem().string()));
  std::vector<BatchStep> batch;
  std::map<std::string, std::string> taken;  // by output
  for (const fs::path& file : files) {
    batch.push_back({file.string(), {}, files.size() > 1});
    if (!output) continue;
    const std::string result = (fs::path(*output) / (file.stem().string() + ".gsf")).string();
    if (const auto [other, is_new] = taken.emplace(result, file.string()); !is_new)
      throw UsageError(
          "--output",
          fmt::format("'{}' and '{}' would both be {}", other->second, file.string(), result),
          "Give scans of different names, or do them one by one");
    std::error_code ignored;
    if (fs::equivalent(file, result, ignored))
      throw UsageError("--output", fmt::format("'{}' would be overwritten", file.string()),
                       "Name another folder");
    batch.back().output = result;
  }
  if (output) {
    std::error_code failed;
    fs::create_directories(*output, failed);
    for (const BatchStep& step : batch) io::check_height_field_target(*step.output);
  }
  return batch;
}

int for_each_scan(const std::vector<BatchStep>& batch,
                  const std::function<void(const BatchStep&)>& work) {
  int code = 0;
  for (const BatchStep& step : batch) {
    try {
      work(step);
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      if (batch.size() == 1) throw;
      const int failed = report_failure();
      if (code == 0) code = failed;
    }
  }
  return code;
}

}  // namespace surf::cli
