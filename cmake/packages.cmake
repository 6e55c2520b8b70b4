# SPDX-License-Identifier: GPL-3.0-or-later
# `cpack -G DEB --config build/CPackConfig.cmake`: Debian's packages, one per component (docs/how-to/packages.md). What Debian
# wants in another form or place than others (compressed pages, its own folders) is installed for its packages alone.
option(SEMSURF_PACKAGES "Debian's packages, by cpack" ON)
if(NOT SEMSURF_PACKAGES)
  return()
endif()

# semsurf_debian_package(COMPONENT NAME SUMMARY text DESCRIPTION text [DEPENDS d] [RECOMMENDS r] [SUGGESTS s]
#                        [SECTION s] [ALSO components...])
function(semsurf_debian_package component name)
  cmake_parse_arguments(ARG "" "SUMMARY;DESCRIPTION;DEPENDS;RECOMMENDS;SUGGESTS;SECTION" "ALSO" ${ARGN})
  string(TOUPPER "${component}" group)
  foreach(part IN ITEMS ${component} LISTS ARG_ALSO)
    string(TOUPPER "${part}" upper)
    set(CPACK_COMPONENT_${upper}_GROUP "${component}" PARENT_SCOPE)
  endforeach()
  set(CPACK_COMPONENT_GROUP_${group}_DESCRIPTION "${ARG_DESCRIPTION}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${group}_PACKAGE_NAME "${name}" PARENT_SCOPE)
  # The first line is the summary; cpack indents the others.
  set(CPACK_DEBIAN_${group}_DESCRIPTION "${ARG_SUMMARY}\n${ARG_DESCRIPTION}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${group}_PACKAGE_SECTION "${ARG_SECTION}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${group}_PACKAGE_DEPENDS "${ARG_DEPENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${group}_PACKAGE_RECOMMENDS "${ARG_RECOMMENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${group}_PACKAGE_SUGGESTS "${ARG_SUGGESTS}" PARENT_SCOPE)
  list(APPEND CPACK_COMPONENTS_ALL ${component} ${ARG_ALSO} ${component}-documents)
  set(CPACK_COMPONENTS_ALL "${CPACK_COMPONENTS_ALL}" PARENT_SCOPE)
  string(TOUPPER "${component}-documents" upper)
  set(CPACK_COMPONENT_${upper}_GROUP "${component}" PARENT_SCOPE)
  install(FILES "${PROJECT_SOURCE_DIR}/packages/debian/copyright" "${SEMSURF_DEBIAN_FILES}/changelog.Debian.gz"
          DESTINATION share/doc/${name} COMPONENT ${component}-documents EXCLUDE_FROM_ALL)
endfunction()

# compress(FILE AS target): as Debian wants it, without name and time.
set(SEMSURF_DEBIAN_FILES "${CMAKE_BINARY_DIR}/debian")
file(MAKE_DIRECTORY "${SEMSURF_DEBIAN_FILES}")
find_program(GZIP gzip)
if(NOT GZIP)
  message(STATUS "No Debian packages: gzip is not there")
  return()
endif()
function(semsurf_compress file as)
  execute_process(COMMAND "${GZIP}" -9nc "${file}" OUTPUT_FILE "${SEMSURF_DEBIAN_FILES}/${as}" COMMAND_ERROR_IS_FATAL ANY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
endfunction()

set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(SEMSURF_PACKAGE_CONTACT "The semsurf authors <semsurf@users.noreply.github.com>" CACHE STRING
    "Who makes the packages: name <mail>")
set(CPACK_PACKAGE_CONTACT "${SEMSURF_PACKAGE_CONTACT}")
string(TIMESTAMP date "%a, %d %b %Y 00:00:00 +0000" UTC)
file(CONFIGURE OUTPUT "${SEMSURF_DEBIAN_FILES}/changelog" @ONLY CONTENT
"semsurf (@PROJECT_VERSION@-@CPACK_DEBIAN_PACKAGE_RELEASE@) bookworm; urgency=medium

  * What changed is in /usr/share/doc/semsurf/changelog.gz.

 -- @CPACK_PACKAGE_CONTACT@  @date@
")
semsurf_compress("${SEMSURF_DEBIAN_FILES}/changelog" changelog.Debian.gz)
semsurf_compress("${PROJECT_SOURCE_DIR}/docs/reference/semsurf.1" semsurf.1.gz)
semsurf_compress("${PROJECT_SOURCE_DIR}/CHANGELOG.md" changelog.gz)
install(FILES "${SEMSURF_DEBIAN_FILES}/semsurf.1.gz" DESTINATION share/man/man1
        COMPONENT program-debian EXCLUDE_FROM_ALL)
install(FILES "${SEMSURF_DEBIAN_FILES}/changelog.gz" README.md DESTINATION share/doc/semsurf
        COMPONENT program-debian EXCLUDE_FROM_ALL)
install(FILES "${CMAKE_BINARY_DIR}/completions/semsurf.zsh" RENAME _semsurf
        DESTINATION share/zsh/vendor-completions COMPONENT program-debian EXCLUDE_FROM_ALL)

set(same "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
set(CPACK_COMPONENTS_ALL)
semsurf_debian_package(program semsurf ALSO program-debian SECTION science
  SUMMARY "simulates SEM images, reconstructs surfaces from AFM and SEM"
  DESCRIPTION "semsurf simulates images of scanning electron microscopes (SEM) of any\ntriangle mesh by Monte Carlo, with standard errors. It cleans scans of atomic\nforce microscopes (AFM), finds their tip and takes it out, and reconstructs\nsurfaces from AFM and SEM images."
  RECOMMENDS "semsurf-io-image, semsurf-io-vtk" SUGGESTS "semsurf-mpi, paraview-semsurf, python3-semsurf")
if(TARGET raster_file OR TARGET cairo_file)
  semsurf_debian_package(io-image semsurf-io-image SECTION science DEPENDS "semsurf ${same}"
    SUMMARY "image files for semsurf"
    DESCRIPTION "Lets semsurf read and write TIFF, PNG and OpenEXR by OpenImageIO, write\nfiles of HyperSpy by HDF5, and draw pictures of electron tracks by Cairo.")
endif()
if(TARGET vtk_file)
  semsurf_debian_package(io-vtk semsurf-io-vtk SECTION science DEPENDS "semsurf ${same}"
    SUMMARY "VTK's files for semsurf"
    DESCRIPTION "Lets semsurf write VTI, VTP and VTM files, as ParaView reads them.")
endif()
if(TARGET mpi_file)
  semsurf_debian_package(mpi semsurf-mpi SECTION science DEPENDS "semsurf ${same}"
    SUMMARY "several machines at one semsurf job"
    DESCRIPTION "Lets many processes of semsurf work at one image, by MPI: mpirun semsurf\nsimulate ... gives the same bytes as one process.")
endif()
if(SEMSURF_PARAVIEW_FOLDER)
  semsurf_compress("${PROJECT_SOURCE_DIR}/packages/debian/paraview-semsurf.1" paraview-semsurf.1.gz)
  install(PROGRAMS packages/debian/paraview-semsurf DESTINATION bin COMPONENT paraview-debian EXCLUDE_FROM_ALL)
  install(FILES packages/debian/paraview-semsurf.desktop DESTINATION share/applications
          COMPONENT paraview-debian EXCLUDE_FROM_ALL)
  install(FILES "${SEMSURF_DEBIAN_FILES}/paraview-semsurf.1.gz" DESTINATION share/man/man1
          COMPONENT paraview-debian EXCLUDE_FROM_ALL)
  semsurf_debian_package(paraview paraview-semsurf ALSO paraview-debian SECTION science DEPENDS "paraview" SUGGESTS "semsurf"
    SUMMARY "semsurf in ParaView"
    DESCRIPTION "Sources, filters, readers and writers of semsurf for ParaView: simulate SEM\nimages, clean AFM scans, reconstruct surfaces and look at them, with the\nmouse.")
endif()
if(TARGET semsurf_python)
  semsurf_debian_package(python-debian python3-semsurf SECTION python
    DEPENDS "semsurf ${same}, python3 (>= 3.11), python3 (<< 3.12), python3-numpy"
    RECOMMENDS "python3-matplotlib, semsurf-io-image, semsurf-io-vtk"
    SUMMARY "semsurf in Python"
    DESCRIPTION "import semsurf: all that the program does, in the same process and to the\nsame bytes, with numpy's arrays in and out.")
endif()
semsurf_debian_package(development libsemsurf-dev SECTION libdevel
  DEPENDS "libembree-dev, libeigen3-dev, libfmt-dev" SUGGESTS "libceres-dev, libopenimageio-dev, cmake"
  SUMMARY "libraries of semsurf, for development"
  DESCRIPTION "Static libraries and headers of semsurf: surfaces and meshes, AFM tools,\nMonte Carlo simulation, fast models, reconstruction, files. Programs find\nthem by CMake's find_package(semsurf).")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")   # each package has its own
set(CPACK_PACKAGE_NAME semsurf)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_DIRECTORY "${CMAKE_BINARY_DIR}/packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
# Folders are not writable for groups, whatever the builder's umask.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_VERBATIM_VARIABLES ON)
include(CPack)
