// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "../exit_codes.h"
#include "command_tree.h"
#include "pages.h"
#include "surf/workflow/version.h"

namespace surf::cli::reference {
namespace {

/// Text that troff shows as it is.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    if (c == '\\') out += "\\e";
    else if (c == '-') out += "\\-";
    else out += c;
  }
  return out;
}

std::string verbatim(const std::string& text) {
  return text.empty() ? "" : ".nf\n" + plain(text) + ".fi\n";
}

/// A heading of a macro: quotes would end it.
std::string heading(const char* macro, std::string text) {
  std::erase(text, '"');
  std::ranges::transform(text, text.begin(), [&](char c) {
    return std::string_view(macro) == "SH" && c >= 'a' && c <= 'z'
               ? static_cast<char>(c - 'a' + 'A')
               : c;
  });
  return fmt::format(".{} \"{}\"\n", macro, plain(text));
}

void add(const CommandText& c, std::string& out) {
  out += heading("SS", c.name);
  out += plain(c.title) + ".\n.PP\n.B " + plain(c.usage) + "\n";
  for (const OptionGroup& group : c.options) {
    out += ".PP\n" + plain(group.heading) + ":\n";
    for (const OptionText& o : group.options) {
      out +=
          fmt::format(".TP\n\\fB{}\\fR{}\n", plain(o.names),
                      o.form.empty() || o.form == o.names ? "" : " \\fI" + plain(o.form) + "\\fR");
      out += plain(o.help) + "\n";
    }
  }
  if (!c.notes.empty()) out += ".PP\n" + verbatim(c.notes);
  if (!c.examples.empty()) out += ".PP\nExamples:\n.PP\n" + verbatim(c.examples);
  for (const CommandText& sub : c.commands) add(sub, out);
}

}  // namespace

std::string manual_page() {
  const CommandText program = read_program();
  std::string out = ".\\\" Made by the program: cmake --build build --target reference\n";
  out += fmt::format(".TH SEMSURF 1 \"\" \"semsurf {}\" \"User Commands\"\n.ad l\n.nh\n",
                     workflow::version());
  out += ".SH NAME\nsemsurf \\- " +
         plain(
             "scanning electron microscope images of surfaces, and surfaces from AFM and "
             "SEM images") +
         "\n";
  out += ".SH SYNOPSIS\n.B semsurf\n.I COMMAND\n[\\fIOPTIONS\\fR]\n";
  out += ".SH DESCRIPTION\n" +
         plain(
             "semsurf simulates SEM images of meshes and height fields by the Monte Carlo "
             "method, learns fast "
             "models of such images, cleans AFM scans and takes the tip off them, and reconstructs "
             "the surface that makes "
             "an AFM scan "
             "and an SEM image most likely. Bare lengths are nm, bare energies eV, bare angles "
             "degrees; all may carry a "
             "unit.") +
         "\n";
  out += ".SH EXAMPLES\n" + verbatim(program.examples);
  std::string group;
  for (const CommandText& c : program.commands) {
    if (c.group != group) out += heading("SH", "Commands: " + c.group);
    group = c.group;
    add(c, out);
  }
  out +=
      ".SH OPTIONS\n.TP\n\\fB\\-h, \\-\\-help\\fR\n" + plain("Help, also after a command") + "\n";
  for (const OptionGroup& options : program.options)
    for (const OptionText& o : options.options)
      out += fmt::format(".TP\n\\fB{}\\fR\n{}\n", plain(o.names), plain(o.help));
  out += ".SH EXIT STATUS\n";
  for (const ExitCode& e : exit_codes)
    out += fmt::format(".TP\n.B {}\n{} {}\n", e.code, plain(e.meaning), plain(e.next));
  out += ".SH ENVIRONMENT\n";
  const std::pair<const char*, const char*> variables[] = {
      {"SEMSURF_CACHE",
       "Folder of libraries of cascades, or off. Without it $XDG_CACHE_HOME/semsurf, else "
       "~/.cache/semsurf."},
      {"SEMSURF_MEMORY",
       "Memory that semsurf takes to be there, as 48GB, or off: nothing is refused for lack of "
       "memory."},
      {"SEMSURF_PYTHON", "The Python that draws charts; it needs Matplotlib."}};
  for (const auto& [name, meaning] : variables)
    out += fmt::format(".TP\n.B {}\n{}\n", name, plain(meaning));
  out += ".SH SEE ALSO\n" +
         plain("Scene files, channels and metadata: docs/reference of the sources.") + "\n";
  return out;
}

}  // namespace surf::cli::reference
