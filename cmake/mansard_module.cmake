# mansard_module(name [IN folder] DEPENDS modules… USES libraries…): the folder mansard/<name>, or <folder>/<name>,
# becomes the library mansard_<name>. Libraries are found when a module names them in USES, and no other module links
# them. Modules IN another folder than mansard/ are not installed. How the others are: cmake/packaging.cmake.
include(GNUInstallDirs)
include(cmake/mansard_libraries.cmake)

function(mansard_module name)
  if(MANSARD_MODULES AND NOT name IN_LIST MANSARD_MODULES)
    return()
  endif()
  cmake_parse_arguments(MODULE "" "IN" "DEPENDS;USES;TESTED_WITH" ${ARGN})
  if(NOT MODULE_IN)
    set(MODULE_IN mansard)
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${MODULE_IN}/${name}/*.cpp)
  add_library(mansard_${name} STATIC ${sources})
  add_library(mansard::${name} ALIAS mansard_${name})
  set_target_properties(mansard_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON MANSARD_DEPENDS "${MODULE_DEPENDS}"
    MANSARD_USES "${MODULE_USES}" MANSARD_TESTED_WITH "${MODULE_TESTED_WITH}")
  if(MODULE_IN STREQUAL mansard)
    set_property(GLOBAL APPEND PROPERTY MANSARD_MODULE_LIST ${name})  # in the order of cmake/modules.cmake
  endif()
  if(NOT PROJECT_IS_TOP_LEVEL AND NOT MANSARD_INSTALL)  # another project builds what it links
    set_target_properties(mansard_${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
  endif()
  target_compile_features(mansard_${name} PUBLIC cxx_std_20)
  target_include_directories(mansard_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  foreach(dependency IN LISTS MODULE_DEPENDS)
    if(NOT TARGET mansard_${dependency})
      message(FATAL_ERROR "MANSARD_MODULES lacks ${dependency}, which ${name} depends on")
    endif()
    target_link_libraries(mansard_${name} PUBLIC mansard_${dependency})
  endforeach()
  foreach(library IN LISTS MODULE_USES)
    mansard_find_library(${library} REQUIRED)
    if(NOT TARGET ${MANSARD_LIBRARY_TARGET})
      message(FATAL_ERROR "${library} was found without the target ${MANSARD_LIBRARY_TARGET}")
    endif()
    if(${library} IN_LIST MANSARD_HEADERS_ONLY)  # those who link the module do not need them
      target_link_libraries(mansard_${name} PRIVATE $<BUILD_INTERFACE:${MANSARD_LIBRARY_TARGET}>)
    else()
      target_link_libraries(mansard_${name} PRIVATE ${MANSARD_LIBRARY_TARGET})
    endif()
  endforeach()
  mansard_precompiled(mansard_${name} modules)
  mansard_united(mansard_${name})
endfunction()
