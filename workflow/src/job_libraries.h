// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

#include "surf/workflow/libraries.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// The libraries of the cache, with the job's own progress and notes.
class JobLibraries : public mc::LibrarySource {
 public:
  JobLibraries(const std::filesystem::path& folder, ProgressCallback progress, NoteCallback note)
      : kept_(folder), progress_(std::move(progress)), note_(std::move(note)) {}

  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings& settings,
                                                    std::size_t cascades, int threads,
                                                    const Watch& watch) override {
    auto library = kept_.library(settings, cascades, threads, {progress_, watch.cancel});
    for (const std::string& text : kept_.take_notes())
      if (note_) note_(text);
    return library;
  }

  CachedLibraries::Pages pages() const { return kept_.pages(); }

 private:
  CachedLibraries kept_;
  ProgressCallback progress_;
  NoteCallback note_;
};

}  // namespace surf::workflow
