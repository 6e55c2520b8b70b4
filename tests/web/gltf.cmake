# SPDX-License-Identifier: GPL-3.0-or-later
# What Khronos' validator and three.js in a browser make of our glTF files. WEB_TEST_FOLDER holds node_modules
# with the packages of package.json; without them, or Node.js, or Chromium, the tests say so and are skipped.
add_executable(web_scenes write_scenes.cpp)
target_include_directories(web_scenes PRIVATE "${PROJECT_SOURCE_DIR}/io/src" "${PROJECT_SOURCE_DIR}/tests/io")
target_link_libraries(web_scenes PRIVATE io fmt::fmt)
semsurf_warnings(web_scenes)
semsurf_loads_modules(web_scenes)
set_target_properties(web_scenes PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")

set(WEB_SCENES "${CMAKE_CURRENT_BINARY_DIR}/scenes")
add_test(NAME web.write_gltf COMMAND web_scenes "${WEB_SCENES}")
set_tests_properties(web.write_gltf PROPERTIES LABELS web FIXTURES_SETUP web_scenes TIMEOUT 60)
find_program(NODE_PROGRAM node)
foreach(script validate_gltf show_gltf)
  if(NODE_PROGRAM)
    add_test(NAME web.${script} COMMAND "${NODE_PROGRAM}" "${CMAKE_CURRENT_LIST_DIR}/${script}.mjs"
             "${WEB_TEST_FOLDER}" "${WEB_SCENES}")
  else()
    add_test(NAME web.${script} COMMAND sh -c "echo 'skipped: no Node.js (./run and ./check install it)'; exit 77")
  endif()
  set_tests_properties(web.${script} PROPERTIES LABELS web FIXTURES_REQUIRED web_scenes TIMEOUT 300
                       SKIP_RETURN_CODE 77)
endforeach()
semsurf_long(web.show_gltf)   # in a browser
