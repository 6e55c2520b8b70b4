# SPDX-License-Identifier: GPL-3.0-or-later
# semsurf_node_packages(RESULT SOURCE FOLDER): FOLDER gets the folder in which cmake/setup.sh has put what
# SOURCE/package-lock.json names. RESULT is true where the packages are there; else it is false and RESULT_reason says
# why. Nothing is fetched here.
find_program(NODE_PROGRAM node)

function(semsurf_node_packages result source folder_result)
  file(RELATIVE_PATH name "${PROJECT_SOURCE_DIR}" "${source}")
  set(folder "${PROJECT_SOURCE_DIR}/.cache/node/${name}")
  set(${folder_result} "${folder}" PARENT_SCOPE)
  set(${result} FALSE PARENT_SCOPE)
  if(NOT NODE_PROGRAM)
    set(${result}_reason "Node.js is missing" PARENT_SCOPE)
    return()
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${source}/package-lock.json")
  file(SHA256 "${source}/package-lock.json" wanted)
  set(there "")
  if(EXISTS "${folder}/installed.txt")
    file(READ "${folder}/installed.txt" there)
    string(STRIP "${there}" there)
  endif()
  if(NOT there STREQUAL wanted)
    set(${result}_reason "the packages of ${name}/package-lock.json are not there; 'cmake/node_packages.sh ${name}' fetches them"
        PARENT_SCOPE)
    return()
  endif()
  set(${result} TRUE PARENT_SCOPE)
endfunction()
