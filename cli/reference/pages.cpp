// SPDX-License-Identifier: GPL-3.0-or-later
#include "pages.h"

#include <fmt/format.h>

#include "../exit_codes.h"
#include "markdown.h"

namespace surf::cli::reference {

std::string exit_codes_page() {
  std::vector<std::vector<std::string>> rows;
  for (const ExitCode& e : exit_codes)
    rows.push_back({std::to_string(e.code), cell(e.meaning), cell(e.next)});
  return page_head("Exit codes",
                   "What `semsurf` tells the shell when it ends. The codes are the same for all "
                   "commands.") +
         "```sh\nsemsurf tip scan.gwy -o tip.txt\ncase $? in\n  0) ;;\n  4) echo \"the tip is "
         "doubtful\" ;;\n"
         "  *) exit 1 ;;\nesac\n```\n\n" +
         table({"Code", "Meaning", "What to do"}, rows);
}

std::string index_page() {
  return page_head(
             "Reference",
             "What there is, in full. The first pages are made from the program itself, and tests "
             "keep them up to date. The last three are written by hand.") +
         table({"Page", "Holds"},
               {{"[Commands](commands.md)",
                 "every command, its options with defaults and ranges, and examples"},
                {"[Scene files](scene_files.md)",
                 "every key of scene and material files, with examples"},
                {"[Channels and metadata](channels_and_metadata.md)",
                 "what images and scans that semsurf writes hold "
                 "and say of themselves"},
                {"[Exit codes](exit_codes.md)", "what `semsurf` tells the shell when it ends"},
                {"[semsurf.1](semsurf.1)",
                 "the manual page: `man semsurf` where semsurf is installed, else `man -l "
                 "docs/reference/semsurf.1`"},
                {"[AFM files](afm_files.md)", "which files of scans are read and written"},
                {"[SEM image files](sem_files.md)", "which files of microscopes are read"},
                {"[Glossary](glossary.md)", "words of the field and of this manual"}});
}

std::map<std::string, std::string> pages() {
  return {{"README.md", index_page()},
          {"commands.md", commands_page()},
          {"scene_files.md", scene_files_page()},
          {"channels_and_metadata.md", results_page()},
          {"exit_codes.md", exit_codes_page()},
          {"semsurf.1", manual_page()}};
}

}  // namespace surf::cli::reference
