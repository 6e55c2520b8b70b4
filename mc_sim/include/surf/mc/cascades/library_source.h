// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/mc/cascades/cascade_library.h"

namespace surf::mc {

/// Libraries by material; null where electrons are followed directly.
using Libraries = std::vector<std::shared_ptr<const CascadeLibrary>>;

/// Where simulations get their libraries of cascades from.
class LibrarySource {
 public:
  virtual ~LibrarySource() = default;

  /// A library of at least `cascades` cascades, with no more pages than that takes, so that what is
  /// drawn from it does not depend on who asked before. Called from one thread at a time. The watch
  /// counts cascades. Throws Interrupted.
  virtual std::shared_ptr<const CascadeLibrary> library(const CascadeSettings& settings,
                                                        std::size_t cascades, int threads,
                                                        const Watch& watch) = 0;
};

/// Makes what is asked for on the spot, and keeps it for who asks for more.
class FreshLibraries : public LibrarySource {
 public:
  std::shared_ptr<const CascadeLibrary> library(const CascadeSettings& settings,
                                                std::size_t cascades, int threads,
                                                const Watch& watch) override;

 private:
  std::map<std::string, CascadeLibrary> kept_;  // by the key of their first page
};

}  // namespace surf::mc
