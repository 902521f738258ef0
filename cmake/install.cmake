# What `cmake --install` and `cpack -G DEB` deliver, in two parts:
#   program      the command, its manual page, shell completion, scenes
#   development  static libraries, headers, the CMake package serosa (targets serosa::sim, serosa::render, ...)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS serosa COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/manual/serosa.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/manual/serosa.bash RENAME serosa
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/manual/_serosa
  DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/manual/serosa.fish
  DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/serosa)
set(headers_folder ${CMAKE_INSTALL_INCLUDEDIR}/serosa)
foreach(folder options base shaders gpu devices sim models render)
  add_library(serosa::${folder} ALIAS serosa_${folder})
  set_target_properties(serosa_${folder} PROPERTIES EXPORT_NAME ${folder})
  install(TARGETS serosa_${folder} EXPORT serosaTargets COMPONENT development
    INCLUDES DESTINATION ${headers_folder})
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.h ${PROJECT_SOURCE_DIR}/${folder}/*.inc)
  install(FILES ${headers} DESTINATION ${headers_folder}/${folder} COMPONENT development)
endforeach()
install(EXPORT serosaTargets NAMESPACE serosa:: DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(cmake/serosaConfig.cmake.in ${PROJECT_BINARY_DIR}/cmake/serosaConfig.cmake
  INSTALL_DESTINATION ${package_folder} NO_SET_AND_CHECK_MACRO)
# Until 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/serosaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cmake/serosaConfig.cmake ${PROJECT_BINARY_DIR}/cmake/serosaConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/copyright
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/serosa-dev COMPONENT development)

# Debian packages: serosa (the program) and serosa-dev (the libraries).
set(CPACK_PACKAGE_NAME serosa)
set(CPACK_PACKAGE_VENDOR "The Serosa authors")
set(CPACK_PACKAGE_CONTACT "The Serosa authors <authors@serosa.invalid>" CACHE STRING "Maintainer of the Debian packages")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Real-time simulator of soft organs")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME serosa)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "A coarse lattice of springs moves, and a detailed surface follows it.
This package holds the serosa command, which simulates scenes with or without
a graphics card.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# EGL, Mesa's drivers and OSMesa are opened at run time, where dpkg-shlibdeps does not see them (libglfw3 brings GLX).
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libosmesa6")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME serosa-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "A coarse lattice of springs moves, and a detailed surface follows it.
This package holds static libraries, headers and a CMake package: lattices,
solvers, surface mappings, OpenGL contexts.")
# What cmake/serosaConfig.cmake.in finds.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libegl-dev, libgl-dev, libglfw3-dev, libglm-dev, \
libhwy-dev, libmeshoptimizer-dev, libopenmesh-dev, libpng-dev, libspdlog-dev, libtbb-dev, libtomlplusplus-dev, libxxhash-dev, \
pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "serosa")
include(CPack)
