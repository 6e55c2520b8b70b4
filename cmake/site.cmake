# SPDX-License-Identifier: GPL-3.0-or-later
# The target `site` writes the web site of the manual into build/site, with MkDocs and Doxygen (site/build.py).
find_package(Python COMPONENTS Interpreter QUIET)
if(Python_FOUND)
  add_custom_target(site
    COMMAND "${Python_EXECUTABLE}" -B "${PROJECT_SOURCE_DIR}/site/build.py" "${PROJECT_SOURCE_DIR}"
            "${CMAKE_BINARY_DIR}/site" $<TARGET_FILE:semsurf_program> "${PROJECT_VERSION}"
    COMMENT "Writing the web site to ${CMAKE_BINARY_DIR}/site" USES_TERMINAL VERBATIM)
endif()
