# Modules: parts that stand on large libraries of others (libsurf/include/surf/core/module.h).
#
# semsurf_module(NAME OF library [PACKAGE component] SOURCES files... [LIBS libs...] [INCLUDES folders...])
# Makes of the sources, one of which has SEMSURF_MODULE(NAME, table),
#   NAME_module   a static library that whoever links `library` links with it, as consumers of the package do, and
#   NAME.so       a file that programs load when they first need it: those that called semsurf_loads_modules(TARGET). It is
#                 installed with the program, or with a package of its own (cmake/packages.cmake).
# The files lie in the same place from the program in the build folder as where both are installed.
set(SEMSURF_MODULE_LIBRARY_FOLDER "${CMAKE_INSTALL_LIBDIR}/semsurf")
file(RELATIVE_PATH SEMSURF_MODULE_FOLDER "/prefix/${CMAKE_INSTALL_BINDIR}" "/prefix/${SEMSURF_MODULE_LIBRARY_FOLDER}")
define_property(TARGET PROPERTY SEMSURF_LOADS_MODULES BRIEF_DOCS "Loads modules when it needs them, and links none")
add_custom_target(semsurf_modules)

function(semsurf_module name)
  cmake_parse_arguments(ARG "" "OF;PACKAGE" "SOURCES;LIBS;INCLUDES" ${ARGN})
  semsurf_library(${name}_module SOURCES ${ARG_SOURCES} PUBLIC ${ARG_OF} PRIVATE ${ARG_LIBS})
  add_library(semsurf::${name}_module ALIAS ${name}_module)
  target_include_directories(${name}_module PRIVATE ${ARG_INCLUDES})
  # Nobody calls it by name: the linker is told to take it.
  target_link_options(${name}_module INTERFACE "LINKER:-u,semsurf_module_${name}")
  target_link_libraries(${ARG_OF} INTERFACE
    "$<$<NOT:$<BOOL:$<TARGET_PROPERTY:SEMSURF_LOADS_MODULES>>>:semsurf::${name}_module>")

  add_library(${name}_file MODULE $<TARGET_OBJECTS:${name}_module>)
  target_link_libraries(${name}_file PRIVATE ${ARG_OF} ${ARG_LIBS})
  target_link_options(${name}_file PRIVATE LINKER:--exclude-libs,ALL)
  set_target_properties(${name}_file PROPERTIES PREFIX "" OUTPUT_NAME ${name} SEMSURF_LOADS_MODULES ON
                        LINKER_LANGUAGE CXX
                        LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${SEMSURF_MODULE_LIBRARY_FOLDER}")
  add_dependencies(semsurf_modules ${name}_file)
  get_target_property(component ${ARG_OF} SEMSURF_COMPONENT)
  install(TARGETS ${name}_module EXPORT semsurf_${component} ARCHIVE DESTINATION "${SEMSURF_MODULE_LIBRARY_FOLDER}")
  if(NOT ARG_PACKAGE)
    set(ARG_PACKAGE program)
  endif()
  install(TARGETS ${name}_file LIBRARY DESTINATION "${SEMSURF_MODULE_LIBRARY_FOLDER}" COMPONENT ${ARG_PACKAGE})
endfunction()

function(semsurf_loads_modules target)
  set_target_properties(${target} PROPERTIES SEMSURF_LOADS_MODULES ON)
  add_dependencies(${target} semsurf_modules)
endfunction()
