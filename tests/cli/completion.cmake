# SPDX-License-Identifier: GPL-3.0-or-later
# What the program tells the shells; their scripts parse, where the shell is there, and bash's completes.
semsurf_cli_test(complete.commands ARGS __complete s STDOUT "^:nothing\nsimulate\tSecondary-.*\nsweep\t.*\nsurvey\t.*\nsample\t.*\n$")
semsurf_cli_test(complete.options ARGS __complete materials --m STDOUT "^:nothing\n--materials\tFile of your own.*\n$")
semsurf_cli_test(complete.files ARGS __complete info x STDOUT "^:files\n$")
semsurf_cli_test(complete.folders ARGS __complete simulate --cache o STDOUT "^:folders\noff\n$")
semsurf_cli_test(complete.nothing ARGS __complete STDOUT "^:nothing\nsimulate")
semsurf_cli_test(complete.unknown ARGS __complete nowhere --what x STDOUT "^:nothing\n$")
foreach(shell bash zsh fish)
  semsurf_cli_test(completion.${shell} ARGS completion ${shell} STDOUT "semsurf" "__complete")
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
