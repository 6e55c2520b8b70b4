// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/team.h"

#include <fmt/format.h>

#include <exception>
#include <thread>

#include "surf/core/error.h"
#include "surf/core/try_thread.h"

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
      throw InvalidInput(fmt::format("rank {}", rank), all[rank],
                         "All machines need the same files in the same places");
}

void lead_while(Team& team, const TakeUnit& take, const GiveUnit& give, const CancelToken* cancel,
                const std::function<void()>& work, const std::function<void()>& end) {
  std::exception_ptr own, of_team;
  {
    // The calling thread leads the team, because MPI may demand that messages come from the thread
    // that initialised it.
    const auto guarded = [&] {
      try {
        work();
      } catch (...) {
        own = std::current_exception();
        end();
      }
    };
    const std::jthread at_work = try_thread(guarded);
    try {
      team.lead(take, give, cancel);
    } catch (...) {
      of_team = std::current_exception();
      end();
    }
    if (!at_work.joinable()) guarded();  // the work that the others have left
  }
  if (own) std::rethrow_exception(own);
  if (of_team) std::rethrow_exception(of_team);
}

std::string once_per_node(NodeMemory* node, const std::function<std::string()>& work) {
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
    throw InvalidInput("specimen", "another process of this machine says: " + text.substr(1),
                       "See there");
  return text.substr(1);
}

}  // namespace surf::workflow
