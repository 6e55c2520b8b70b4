# SPDX-License-Identifier: GPL-3.0-or-later
# semsurf_node_packages(RESULT SOURCE_FOLDER FOLDER): installs what SOURCE_FOLDER/package-lock.json names into
# FOLDER/node_modules, again only where the lock has changed. RESULT is true where the packages are there;
# else it is false and RESULT_reason says why.
find_program(NODE_PROGRAM node)
find_program(NPM_PROGRAM npm)

function(semsurf_node_packages result source folder)
  set(${result} FALSE PARENT_SCOPE)
  set(${result}_reason "Node.js and npm are missing" PARENT_SCOPE)
  if(NOT NODE_PROGRAM OR NOT NPM_PROGRAM)
    return()
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${source}/package-lock.json")
  file(SHA256 "${source}/package-lock.json" wanted)
  set(there "")
  if(EXISTS "${folder}/installed.txt")
    file(READ "${folder}/installed.txt" there)
  endif()
  if(NOT there STREQUAL wanted)
    message(STATUS "Fetching the packages of ${source}/package-lock.json")
    file(COPY "${source}/package.json" "${source}/package-lock.json" "${source}/.npmrc" DESTINATION "${folder}")
    file(REMOVE "${folder}/installed.txt")
    execute_process(COMMAND "${NPM_PROGRAM}" ci --ignore-scripts --no-audit --no-fund --loglevel=error
                    WORKING_DIRECTORY "${folder}" TIMEOUT 300
                    RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
    if(NOT failed STREQUAL "0")
      file(WRITE "${folder}/npm.log" "${said}")
      set(${result}_reason "npm ci failed, see ${folder}/npm.log" PARENT_SCOPE)
      return()
    endif()
    file(WRITE "${folder}/installed.txt" "${wanted}")
  endif()
  set(${result} TRUE PARENT_SCOPE)
endfunction()
