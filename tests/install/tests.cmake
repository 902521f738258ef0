# Tests of what is delivered. They need the whole build and a real one: no sanitizers, no coverage. Tests of the
# configuration `nightly` run with `ctest -C nightly` only.
if(SEROSA_SANITIZE OR SEROSA_COVERAGE)
  return()
endif()

# The outside project's program inside the build, for its hash.
add_executable(serosa_test_install ${CMAKE_CURRENT_LIST_DIR}/main.cpp)
target_link_libraries(serosa_test_install PRIVATE serosa_models)

add_test(NAME install_prefix COMMAND ${CMAKE_CURRENT_LIST_DIR}/prefix_test
  ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} $<TARGET_FILE:serosa_test_install>)
add_test(NAME install_deb COMMAND ${CMAKE_CURRENT_LIST_DIR}/deb_test
  ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} $<TARGET_FILE:serosa_test_install> CONFIGURATIONS nightly)
set_tests_properties(install_prefix install_deb PROPERTIES TIMEOUT 600 ENVIRONMENT "CMAKE=${CMAKE_COMMAND}")
set_tests_properties(install_deb PROPERTIES LABELS nightly)
