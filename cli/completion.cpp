// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>

#include "commands.h"
#include "surf/core/error.h"
#include "terminal.h"

// The scripts ask the program itself what may come next (complete.h), so that they never get out of
// date.

namespace surf::cli {
namespace {

constexpr const char* completion_examples = R"(Examples:
  source <(semsurf completion bash)                                    # in ~/.bashrc
  semsurf completion zsh > "${fpath[1]}/_semsurf"
  semsurf completion fish > ~/.config/fish/completions/semsurf.fish)";

// Bash ends words at "=" and ":" too: what stands before the current piece is taken off the
// answers.
constexpr const char* bash_script =
    R"(# bash completion for semsurf, made by "semsurf completion bash"
_semsurf() {
  local cur=${COMP_WORDS[COMP_CWORD]} line=${COMP_LINE:0:COMP_POINT} lines i
  [[ $cur == [=:] ]] && cur=
  line=${line##*[[:space:]]}
  mapfile -t lines < <("${1/#\~/$HOME}" __complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  COMPREPLY=()
  for i in "${lines[@]:1}"; do i=${i%%$'\t'*}; COMPREPLY+=("${i#"${line%"$cur"}"}"); done
  case ${lines[0]-} in
    :files) mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- "$cur"); compopt -o filenames 2>/dev/null || : ;;
    :folders) mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$cur"); compopt -o filenames 2>/dev/null || : ;;
  esac
  [[ ${COMPREPLY[0]-} == *= ]] && compopt -o nospace 2>/dev/null || :
  return 0
}
complete -F _semsurf semsurf
)";

constexpr const char* zsh_script = R"(#compdef semsurf
# zsh completion for semsurf, made by "semsurf completion zsh"
_semsurf() {
  local -a lines offered space
  local line word
  lines=("${(@f)$(${~words[1]} __complete "${(@Q)words[2,CURRENT-1]}" "${(Q)PREFIX}" 2>/dev/null)}")
  for line in "${(@)lines[2,-1]}"; do
    [[ -n $line ]] || continue
    word=${line%%$'\t'*}
    [[ $word == *= ]] && space=(-S '')
    offered+=("${word//:/\\:}${${line#$word}/$'\t'/:}")
  done
  (( $#offered )) && _describe -V value offered $space
  case $lines[1] in
    :files) _files ;;
    :folders) _files -/ ;;
  esac
}
if [[ $funcstack[1] == _semsurf ]]; then _semsurf "$@"; else compdef _semsurf semsurf; fi
)";

constexpr const char* fish_script =
    R"(# fish completion for semsurf, made by "semsurf completion fish"
function __semsurf_complete
  set -l words (commandline -opc)
  set -l word (commandline -ct)
  set -l lines ($words[1] __complete $words[2..-1] "$word" 2>/dev/null)
  printf '%s\n' $lines[2..-1]
  switch "$lines[1]"
    case :files
      __fish_complete_path "$word"
    case :folders
      __fish_complete_directories "$word"
  end
end
complete -c semsurf -f -a '(__semsurf_complete)'
)";

const char* script_for(const std::string& shell) {
  if (shell == "bash") return bash_script;
  if (shell == "zsh") return zsh_script;
  if (shell == "fish") return fish_script;
  throw UsageError("completion", shell.empty() ? "no shell is given" : "unknown shell " + shell,
                   "Choose bash, zsh or fish");
}

}  // namespace

void add_completion(CLI::App& app, Action& action) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* sub = app.add_subcommand("completion", "A completion script for the shell");
  sub->add_option("SHELL", *shell, "The shell")->type_name("bash|zsh|fish");
  sub->footer(completion_examples);
  sub->callback([shell, &action] {
    action = [shell] {
      print("{}", script_for(*shell));
      return 0;
    };
  });
}

}  // namespace surf::cli
