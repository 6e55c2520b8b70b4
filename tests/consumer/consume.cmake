# Installs BUILD under WORK, builds PROJECT against it or, where COMPONENTS are named, the program of each of them, runs
# what comes out, leaves nothing behind.
set(prefix "${WORK}/prefix")
file(REMOVE_RECURSE "${WORK}")

function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    file(REMOVE_RECURSE "${WORK}")
    list(JOIN ARGN " " command)
    message("${output}")
    message(FATAL_ERROR "Failed (${status}): ${command}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

step("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}")

# A component brings what it uses and nothing else: neither is more looked for, nor linked.
set(packages Ceres embree OpenImageIO OpenSSL tomlplusplus nlohmann_json pugixml TinyGLTF ZLIB ParaView VTK MPI)
set(libraries ceres cholmod openblas fftw3f nlopt OpenMesh embree OpenImageIO vtk toml mpi)
set(packages_of_sem Ceres)
set(packages_of_reconstruction Ceres)
set(libraries_of_mesh OpenMesh)
set(libraries_of_registration fftw3f nlopt)
set(libraries_of_compare fftw3f nlopt)
set(libraries_of_profile OpenMesh nlopt)
set(libraries_of_refinement OpenMesh)
set(libraries_of_sem OpenMesh ceres cholmod openblas)   # which Ceres itself brings
set(libraries_of_reconstruction OpenMesh ceres cholmod nlopt openblas)
foreach(component IN LISTS COMPONENTS)
  set(forbidden ${packages})
  list(REMOVE_ITEM forbidden ${packages_of_${component}} "")
  step("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${PROJECT}" -B "${WORK}/${component}"
       "-DCMAKE_PREFIX_PATH=${prefix}" "-DCOMPONENT=${component}" "-DFORBIDDEN=${forbidden}"
       "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
       "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}" "-DCMAKE_CXX_FLAGS_DEBUG=${FLAGS_DEBUG}")
  step("${CMAKE_COMMAND}" --build "${WORK}/${component}" --verbose)
  string(REGEX MATCHALL "[^\n]*semsurf/lib[^\n]*" linked "${output}")
  set(unwanted ${libraries})
  list(REMOVE_ITEM unwanted ${libraries_of_${component}} "")
  list(JOIN unwanted "|" unwanted)
  if(NOT linked OR linked MATCHES "lib(${unwanted})")
    file(REMOVE_RECURSE "${WORK}")
    message(FATAL_ERROR "${component} links ${CMAKE_MATCH_0}: ${linked}")
  endif()
  step("${WORK}/${component}/component")
  message(STATUS "${component} links what it uses")
endforeach()
if(COMPONENTS)
  file(REMOVE_RECURSE "${WORK}")
  return()
endif()

foreach(file bin/semsurf include/surf/mc/simulate.h include/surf/io/sim/materials.h
             share/doc/semsurf/LICENSE ${MODULES}/raster.so ${MODULES}/ceres.so
             ${MODULES}/cholmod.so)
  if(NOT EXISTS "${prefix}/${file}")
    file(REMOVE_RECURSE "${WORK}")
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()
step("${prefix}/bin/semsurf" --version)
message(STATUS "${output}")
# Its modules are those beside it.
step("${prefix}/bin/semsurf" simulate "${SCENE}" --electrons 1 --size 4x4 -q -o "${WORK}/flat.exr")

step("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${PROJECT}" -B "${WORK}/build"
     "-DCMAKE_PREFIX_PATH=${prefix}" "-DWANTED_VERSION=${VERSION}"
     "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
     "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}" "-DCMAKE_CXX_FLAGS_DEBUG=${FLAGS_DEBUG}")
step("${CMAKE_COMMAND}" --build "${WORK}/build")
step("${WORK}/build/all_libraries")
step("${WORK}/build/consumer")
message(STATUS "${output}")
if(NOT output MATCHES "yield SE [0-9.]+ BSE [0-9.]+")
  message(FATAL_ERROR "No yield in: ${output}")
endif()
file(REMOVE_RECURSE "${WORK}")
