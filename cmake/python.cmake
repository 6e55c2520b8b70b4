# `import semsurf` (python/): built where Python's headers and pybind11 are.
option(SEMSURF_PYTHON "The Python package, where Python's headers and pybind11 are" ON)
set(SEMSURF_PYTHON_SITE "" CACHE STRING
    "Folder of Python packages below the prefix; empty: where its Python looks for them")
if(NOT SEMSURF_PYTHON)
  return()
endif()
# The system's Python, for which the system's packages are, and not one that is before it in PATH.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
set(PYBIND11_FINDPYTHON ON)
find_package(Python QUIET COMPONENTS Interpreter Development.Module)
if(Python_Development.Module_FOUND)
  find_package(pybind11 2.10 QUIET CONFIG)
endif()
if(NOT pybind11_FOUND)
  message(STATUS "No Python package: python3-dev or pybind11-dev is not there")
  return()
endif()
set(site "${SEMSURF_PYTHON_SITE}")
if(NOT site)
  # Below /usr Debian's packages are in another folder than what is installed by hand below /usr/local.
  if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND EXISTS /usr/lib/python3/dist-packages)
    set(site lib/python3/dist-packages)
  else()
    execute_process(
      COMMAND "${Python_EXECUTABLE}" -c
              "import sysconfig; print(sysconfig.get_path('platlib', vars=dict(platbase='', base='')))"
      OUTPUT_VARIABLE site OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(REGEX REPLACE "^/(local/)?" "" site "${site}")
  endif()
endif()
# The package in the build folder: its tests take it from there.
set(SEMSURF_PYTHON_FOLDER "${CMAKE_BINARY_DIR}/python")
add_subdirectory(python)
