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

std::string once_per_node(mc::NodeMemory* node, const std::function<std::string()>& work) {
  if (!node) return work();
  std::string text;
  if (node->is_first()) {
    try {
      text = " " + work();
    } catch (const std::exception& e) {
      text = std::string("!") + e.what();
      node->tell(text);
      throw;
    }
  }
  node->tell(text);
  if (text[0] == '!')
    throw InvalidInput("specimen", "another process of this machine says: " + text.substr(1), "See there");
  return text.substr(1);
}

}  // namespace surf::workflow
