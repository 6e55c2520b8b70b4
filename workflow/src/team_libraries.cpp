// SPDX-License-Identifier: GPL-3.0-or-later
#include "team_libraries.h"

#include <exception>
#include <map>
#include <span>
#include <string>

#include "library_page.h"
#include "surf/core/error.h"

namespace surf::workflow {

std::shared_ptr<const mc::CascadeLibrary> TeamLibraries::library(
    const mc::CascadeSettings& settings, std::size_t cascades, int threads, const Watch& watch) {
  std::shared_ptr<const mc::CascadeLibrary> library;
  together(&team_, [&] {
    if (!team_.leads()) return;
    try {
      library = own_.library(settings, cascades, threads, watch);
    } catch (const Interrupted&) {  // all members are told below
    }
  });
  std::string pages = library ? std::to_string(library->pages()) : std::string();
  team_.broadcast(pages);
  if (pages.empty()) throw Interrupted();
  mc::CascadeLibrary copy(settings);
  const std::size_t count = std::stoul(pages);
  for (std::size_t i = 0; i < count; ++i) {
    std::string bytes;
    if (team_.leads()) {
      const std::vector<std::byte> packed = page_to_bytes(library->page(i));
      bytes.assign(reinterpret_cast<const char*>(packed.data()), packed.size());
    }
    team_.broadcast(bytes);
    if (team_.leads()) continue;
    auto page = page_from_bytes(std::as_bytes(std::span(bytes)));
    if (!page) throw InvalidInput("library of cascades", "it did not arrive whole", "Start again");
    copy.add_page(std::make_shared<const mc::CascadePage>(std::move(*page)));
  }
  return team_.leads() ? library : std::make_shared<const mc::CascadeLibrary>(std::move(copy));
}

}  // namespace surf::workflow
