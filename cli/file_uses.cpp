// SPDX-License-Identifier: GPL-3.0-or-later
#include "file_uses.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <system_error>

#include "bound_parameters.h"
#include "surf/core/error.h"
#include "surf/io/sim/scene_file.h"
#include "surf/workflow/chain_chart_job.h"
#include "surf/workflow/chart_job.h"
#include "surf/workflow/reconstruct_job.h"

namespace surf::cli {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Without ":CHANNEL".
fs::path file_in(const std::string& value) {
  if (is_file(value)) return value;
  const std::size_t colon = value.rfind(':');
  return colon == std::string::npos ? value : value.substr(0, colon);
}

std::string name_of(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().front();
}

bool is_output(const CLI::Option& option) {
  const FileRole role = file_role(option).value_or(FileRole::none);
  return role == FileRole::written || role == FileRole::written_folder;
}

void add_output(const std::string& option, const fs::path& path,
                std::vector<io::FileUse>& outputs) {
  for (const fs::path& file : io::files_written_with(path))
    outputs.push_back({option, file, file == path ? fs::path() : path});
}

/// What the command writes to a folder under names of its own.
std::vector<fs::path> files_in(const fs::path& folder, const std::string& command) {
  if (command == "reconstruct") return workflow::reconstruction_files(folder);
  if (command != "chart") return {};
  std::vector<fs::path> files = workflow::chart_files(folder);
  for (const fs::path& file : workflow::chain_chart_files(folder))  // some names are the same
    if (std::ranges::find(files, file) == files.end()) files.push_back(file);
  return files;
}

}  // namespace

std::vector<io::FileUse> files_read(const std::string& option, const std::string& value) {
  const fs::path path = file_in(value);
  if (!is_file(path)) return {};
  std::vector<fs::path> files;
  try {
    files = io::is_scene_file(path) ? io::scene_input_files(path) : io::files_read_with(path);
  } catch (const Error&) {
    files = {path};  // reading the scene will say what is wrong
  }
  std::vector<io::FileUse> uses;
  for (const fs::path& file : files)
    uses.push_back({option, file, file == path ? fs::path() : path});
  return uses;
}

void refuse_overlaps(const CLI::App& command) {
  std::vector<io::FileUse> inputs, outputs;
  for (const CLI::Option* option : command.get_options()) {
    if (!is_output(*option)) continue;
    const bool is_folder = file_role(*option) == FileRole::written_folder;
    for (const std::string& value : option->results()) {
      if (!is_folder) add_output(name_of(*option), value, outputs);
      else
        for (const fs::path& file : files_in(value, command.get_name()))
          outputs.push_back({name_of(*option), file, {}});
    }
  }
  if (outputs.empty()) return;  // the inputs need not be looked at
  for (const CLI::Option* option : command.get_options()) {
    if (file_role(*option) != FileRole::read) continue;
    for (const std::string& value : option->results())
      std::ranges::copy(files_read(name_of(*option), value), std::back_inserter(inputs));
  }
  io::refuse_overlaps(inputs, outputs);
}

}  // namespace surf::cli
