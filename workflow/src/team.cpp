// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/team.h"

#include <fmt/format.h>

#include <exception>

#include "surf/core/error.h"

namespace surf::workflow {

void together(Team* team, const std::function<void()>& part) {
  if (!team) return part();
  std::exception_ptr error;
  std::string text;
  try {
    part();
  } catch (const std::exception& e) {
    error = std::current_exception();
    text = e.what();
    if (text.empty()) text = "it failed";
  }
  const std::vector<std::string> all = team->exchange(text);
  if (error) std::rethrow_exception(error);
  for (std::size_t rank = 0; rank < all.size(); ++rank)
    if (!all[rank].empty())
      throw InvalidInput(fmt::format("rank {}", rank), all[rank], "All machines need the same files in the same places");
}

}  // namespace surf::workflow
