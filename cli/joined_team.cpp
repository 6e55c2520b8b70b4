// SPDX-License-Identifier: GPL-3.0-or-later
#include "joined_team.h"

#include <fmt/format.h>

#include <memory>

#include "surf/workflow/join_team.h"
#include "terminal.h"

namespace surf::cli {
namespace {

std::unique_ptr<workflow::Team> joined;

}  // namespace

void join_team() { joined = workflow::join_started_team(); }

workflow::Team* team() { return joined.get(); }

int processes_here() {
  workflow::NodeMemory* const node = workflow::node_of(team());
  return node ? node->processes() : 1;
}

bool leave_to_leader(const std::string& command) {
  if (!joined) return false;
  if (!joined->leads()) return true;
  const int others = joined->size() - 1;
  print_note(fmt::format("'semsurf {}' is the work of one process: {} other{} nothing to do",
                         command, others, others == 1 ? " has" : "s have"));
  return false;
}

void leave_team() { joined.reset(); }

}  // namespace surf::cli
