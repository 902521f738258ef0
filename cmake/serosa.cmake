# serosa_library(NAME LINK...): a static library of every .cpp file of the current folder.
function(serosa_library name)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  if(NOT sources MATCHES "\\.cpp")
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE serosa_options ${ARGN})
    return()
  endif()
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC serosa_options ${ARGN})
  serosa_precompile(${name})
endfunction()

# serosa_precompile(TARGET HEADER...): parses once what most files of a target include. A file still names what it uses: presets
# without (SEROSA_PRECOMPILE) compile it as it stands. Of precompiled headers g++ forgets that they are the system's, and warns of
# copies in them that it does not follow (GCC bug 105651 and its kin).
function(serosa_precompile target)
  if(SEROSA_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <map>
      <memory> <optional> <span> <string> <utility> <vector> <glm/glm.hpp> ${ARGN})
    target_compile_options(${target} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>
      $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overread>)
  endif()
endfunction()
