# SPDX-License-Identifier: GPL-3.0-or-later
# The completion scripts parse, where the shell is there, and bash's completes.
foreach(shell bash zsh fish)
  semsurf_cli_test(completion.${shell} ARGS completion ${shell}
    STDOUT "semsurf" "pixel-size" "mirror" "Si")
  find_program(SHELL_${shell} ${shell})
  if(SHELL_${shell})
    add_test(NAME cli.completion.${shell}.parses
             COMMAND bash -c "'$<TARGET_FILE:semsurf_program>' completion ${shell} | '${SHELL_${shell}}' -n /dev/stdin")
    set_tests_properties(cli.completion.${shell}.parses PROPERTIES LABELS cli TIMEOUT 60)
  endif()
endforeach()
add_test(NAME cli.completion.bash.completes
         COMMAND bash "${CMAKE_CURRENT_LIST_DIR}/completion_test.sh" $<TARGET_FILE:semsurf_program>)
set_tests_properties(cli.completion.bash.completes PROPERTIES LABELS cli TIMEOUT 60)
