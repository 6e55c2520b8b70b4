# semsurf_library(NAME COMPONENT component SOURCES ... PUBLIC libs... PRIVATE libs...): a static library with its public
# headers in include/, its private ones in src/, warnings on. It is installed as semsurf::COMPONENT, and
# find_package(semsurf COMPONENTS COMPONENT) looks for what it stands on alone (cmake/semsurfConfig.cmake.in).
function(semsurf_library name)
  cmake_parse_arguments(ARG "" "COMPONENT" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  if(ARG_COMPONENT)
    add_library(semsurf::${ARG_COMPONENT} ALIAS ${name})
    set_target_properties(${name} PROPERTIES EXPORT_NAME ${ARG_COMPONENT} SEMSURF_COMPONENT ${ARG_COMPONENT})
    set_property(GLOBAL APPEND PROPERTY SEMSURF_COMPONENTS ${ARG_COMPONENT})
    install(TARGETS ${name} EXPORT semsurf_${ARG_COMPONENT} ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}/semsurf")
  endif()
  target_include_directories(${name}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  target_compile_features(${name} PUBLIC cxx_std_20)
  semsurf_warnings(${name})
endfunction()

function(semsurf_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor
                         -Wno-missing-field-initializers -Werror=narrowing)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # libstdc++ 12's strings draw these from themselves (GCC bugs 105329, 105651).
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow
                           -Wno-stringop-overread)
  endif()
endfunction()

# semsurf_cold(TARGET [LEVEL]): nothing in it is worth optimising far: -O1, or LEVEL. Files that are get -O3 of their own
# (set_source_files_properties(... COMPILE_OPTIONS -O3 SKIP_PRECOMPILE_HEADERS ON)).
function(semsurf_cold target)
  set(level -O1)
  if(ARGN)
    set(level ${ARGN})
  endif()
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:${level}>)
endfunction()

# semsurf_hot(files...): optimised as far as it goes in a target that is cold.
function(semsurf_hot)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "$<$<CONFIG:Release>:-O3>"
                              SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# semsurf_precompile(TARGET [headers...]): what nearly all of its files include, and these headers, once for all.
function(semsurf_precompile target)
  if(SEMSURF_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map>
      <memory> <optional> <span> <string> <string_view> <utility> <vector> <fmt/format.h> ${ARGN})
  endif()
endfunction()

# semsurf_unity(TARGET ALONE files...): several sources are compiled as one, so that headers are read and templates made
# once for all of them. Names in the unnamed namespaces of ALONE are those of other sources: they are compiled apart, as are
# sources with options of their own.
function(semsurf_unity target)
  cmake_parse_arguments(ARG "" "" "ALONE" ${ARGN})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SEMSURF_UNITY} UNITY_BUILD_BATCH_SIZE 8)
  set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
