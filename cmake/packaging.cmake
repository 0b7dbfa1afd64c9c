# What is installed, and the packages made of it: docs/packaging.md.
#   component extrude    the extrusion kernel and what it depends on: libraries, public headers, their part of the CMake package
#   component engine     the same of every other module
#   component program    mansard, its manual page, the shells' completions, the samples, the plugin of QGIS
#   component python     the Python package
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mansard)
get_property(modules GLOBAL PROPERTY MANSARD_MODULE_LIST)

# The module and those that it depends on.
function(mansard_reach name result)
  set(reach "")
  set(open ${name})
  while(open)
    list(POP_FRONT open module)
    if(NOT module IN_LIST reach)
      list(APPEND reach ${module})
      get_target_property(depends mansard_${module} MANSARD_DEPENDS)
      list(APPEND open ${depends})
    endif()
  endwhile()
  set(${result} ${reach} PARENT_SCOPE)
endfunction()

set(kernel "")
if(TARGET mansard_extrude)
  mansard_reach(extrude kernel)
endif()
foreach(module IN LISTS modules)
  set(component engine)
  if(module IN_LIST kernel)  # an export belongs to one component
    set(component extrude)
  endif()
  install(TARGETS mansard_${module} EXPORT mansard_${module} COMPONENT ${component})
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/mansard/${module}/*.hpp)  # the public ones
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mansard/${module} COMPONENT ${component})
  install(EXPORT mansard_${module} NAMESPACE mansard:: FILE mansard_${module}.cmake DESTINATION ${package_dir}
    COMPONENT ${component})
endforeach()

# The package file knows every module's dependencies and libraries, whichever of them are installed.
set(MANSARD_CONFIG_MODULES "${modules}")
list(JOIN MANSARD_CONFIG_MODULES " " MANSARD_CONFIG_MODULES)
set(MANSARD_CONFIG_DEPENDS "")
foreach(module IN LISTS modules)
  get_target_property(depends mansard_${module} MANSARD_DEPENDS)
  get_target_property(uses mansard_${module} MANSARD_USES)
  list(JOIN depends " " depends)
  list(JOIN uses " " uses)
  string(APPEND MANSARD_CONFIG_DEPENDS "set(_mansard_depends_${module} ${depends})\nset(_mansard_uses_${module} ${uses})\n")
endforeach()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/mansardConfig.cmake.in
  ${PROJECT_BINARY_DIR}/mansardConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mansardConfigVersion.cmake COMPATIBILITY SameMinorVersion)
foreach(component IN ITEMS extrude engine)  # either may be installed without the other's files
  install(FILES ${PROJECT_BINARY_DIR}/mansardConfig.cmake ${PROJECT_BINARY_DIR}/mansardConfigVersion.cmake
    ${PROJECT_SOURCE_DIR}/cmake/mansard_libraries.cmake DESTINATION ${package_dir} COMPONENT ${component})
endforeach()

# Debian's changelog, which every package has.
find_program(GZIP gzip REQUIRED)
set(made ${PROJECT_BINARY_DIR}/packaging)
configure_file(${PROJECT_SOURCE_DIR}/packaging/changelog.in ${made}/changelog @ONLY)
execute_process(COMMAND ${GZIP} -9nkf ${made}/changelog COMMAND_ERROR_IS_FATAL ANY)
set(notices ${made}/changelog.gz ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/NOTICE ${PROJECT_SOURCE_DIR}/packaging/copyright)
install(FILES ${notices} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libmansard-dev COMPONENT extrude)

if(NOT TARGET mansard)
  return()
endif()

# ---- the program, and what it says of itself
install(TARGETS mansard COMPONENT program)
install(TARGETS mansard_reader DESTINATION libexec/mansard COMPONENT program)
add_custom_command(OUTPUT ${made}/mansard.1.gz ${made}/mansard.bash ${made}/_mansard ${made}/mansard.fish
  COMMAND mansard manual > ${made}/mansard.1
  COMMAND ${GZIP} -9nf ${made}/mansard.1
  COMMAND mansard completion bash > ${made}/mansard.bash
  COMMAND mansard completion zsh > ${made}/_mansard
  COMMAND mansard completion fish > ${made}/mansard.fish
  DEPENDS mansard COMMENT "Asking mansard for its manual page and completions" VERBATIM)
add_custom_target(mansard_manual ALL
  DEPENDS ${made}/mansard.1.gz ${made}/mansard.bash ${made}/_mansard ${made}/mansard.fish)
install(FILES ${made}/mansard.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${made}/mansard.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME mansard
  COMPONENT program)
install(FILES ${made}/_mansard DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${made}/mansard.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/tools/blender_import.py DESTINATION ${CMAKE_INSTALL_DATADIR}/mansard COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data DESTINATION ${CMAKE_INSTALL_DATADIR}/mansard COMPONENT program)
install(FILES ${notices} ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/README.md
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/mansard COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/mansard COMPONENT program
  FILES_MATCHING PATTERN "*.md" PATTERN "*.json" PATTERN "*.ipynb")

# ---- the Python package, and the plugin of QGIS
set(components program extrude engine)
if(TARGET mansard_python)
  list(APPEND components python)
  install(DIRECTORY ${MANSARD_PYTHON_DIR}/mansard DESTINATION lib/python3/dist-packages COMPONENT python
    PATTERN "__pycache__" EXCLUDE PATTERN "*.so" EXCLUDE)
  install(TARGETS mansard_python LIBRARY DESTINATION lib/python3/dist-packages/mansard COMPONENT python)  # stripped
  install(FILES ${notices} ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-mansard
    COMPONENT python)
endif()
add_dependencies(mansard_manual mansard_qgis)
install(DIRECTORY ${PROJECT_BINARY_DIR}/qgis/mansard DESTINATION ${CMAKE_INSTALL_DATADIR}/qgis/python/plugins
  COMPONENT program)

# ---- Debian packages: cpack -G DEB
set(CPACK_PACKAGE_NAME mansard)
set(CPACK_PACKAGE_VENDOR "the mansard contributors")
set(CPACK_PACKAGE_CONTACT "the mansard contributors <contact@mansard.example>")
set(CPACK_PACKAGE_HOMEPAGE_URL "https://mansard.example")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "city mesh and footprints to labelled, watertight building models")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${made})
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_COMPONENT_EXTRUDE_GROUP dev)
set(CPACK_COMPONENT_ENGINE_GROUP dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME mansard)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)  # the libraries of the machine that builds: Debian 12
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
  "A noisy city mesh and its building footprints in; clean, watertight,
wall-and-roof-labelled building models out, which stay editable as plan +
profiles. With manual page, completions for bash, zsh and fish, the plugin of
QGIS, and samples in /usr/share/mansard/data.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libmansard-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libtbb-dev, libgmp-dev, libgeos-dev, libembree-dev (>= 3.13), coinor-libcbc-dev, \
libgdal-dev, libtinygltf-dev, libdraco-dev, libmeshoptimizer-dev, libssl-dev, libxml2-dev, libpng-dev, pkg-config")
set(CPACK_COMPONENT_GROUP_DEV_DESCRIPTION
  "The modules of mansard as static libraries with their public headers, for
find_package(mansard COMPONENTS pipeline).")
set(CPACK_COMPONENT_EXTRUDE_DESCRIPTION "${CPACK_COMPONENT_GROUP_DEV_DESCRIPTION}")
set(CPACK_COMPONENT_ENGINE_DESCRIPTION "${CPACK_COMPONENT_GROUP_DEV_DESCRIPTION}")
set(CPACK_DEBIAN_DEV_DESCRIPTION "${CPACK_COMPONENT_GROUP_DEV_DESCRIPTION}")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-mansard)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "mansard")  # mansard-reader
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
  "The engine of mansard for Python: building models of meshes and footprints,
as numpy arrays and editable plans.")
include(CPack)
