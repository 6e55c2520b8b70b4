# What `cmake --install` gives: libraries, headers, the program, the package for find_package(semsurf). Each part is a
# component of the package that it belongs to (cmake/packages.cmake); what names none is for developers,
# and `plain` is what Debian's packages have in another form.
include(CMakePackageConfigHelpers)
set(SEMSURF_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/semsurf")

foreach(folder libsurf mc_sim io workflow)
  install(DIRECTORY ${folder}/include/ DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
          FILES_MATCHING PATTERN "*.h")
endforeach()
install(TARGETS semsurf_program RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT program)

# Shell completion, printed by the program itself.
set(completions)
foreach(shell bash zsh fish)
  set(file "${CMAKE_BINARY_DIR}/completions/semsurf.${shell}")
  add_custom_command(OUTPUT "${file}" COMMAND semsurf_program completion ${shell} > "${file}"
                     DEPENDS semsurf_program COMMENT "Completion for ${shell}")
  list(APPEND completions "${file}")
endforeach()
file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/completions")
add_custom_target(completions ALL DEPENDS ${completions})
install(FILES "${CMAKE_BINARY_DIR}/completions/semsurf.bash" RENAME semsurf
        DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT program)
install(FILES "${CMAKE_BINARY_DIR}/completions/semsurf.zsh" RENAME _semsurf
        DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions" COMPONENT plain)
install(FILES "${CMAKE_BINARY_DIR}/completions/semsurf.fish"
        DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" COMPONENT program)

install(FILES docs/reference/semsurf.1 DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT plain)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT plain)

get_property(SEMSURF_COMPONENTS GLOBAL PROPERTY SEMSURF_COMPONENTS)
foreach(component IN LISTS SEMSURF_COMPONENTS)
  install(EXPORT semsurf_${component} NAMESPACE semsurf:: DESTINATION "${SEMSURF_PACKAGE_DIR}")
endforeach()
set(SEMSURF_VTK_OF_PARAVIEW OFF)
if(SEMSURF_VTK AND ParaView_FOUND)
  set(SEMSURF_VTK_OF_PARAVIEW ON)
endif()
configure_package_config_file(cmake/semsurfConfig.cmake.in
  "${CMAKE_BINARY_DIR}/semsurfConfig.cmake" INSTALL_DESTINATION "${SEMSURF_PACKAGE_DIR}")
write_basic_package_version_file("${CMAKE_BINARY_DIR}/semsurfConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/semsurfConfig.cmake"
              "${CMAKE_BINARY_DIR}/semsurfConfigVersion.cmake"
        DESTINATION "${SEMSURF_PACKAGE_DIR}")
