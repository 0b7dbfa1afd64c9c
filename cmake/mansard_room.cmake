# mansard_room(name DEPENDS rooms… USES libraries…): the folder mansard/<name> becomes the library mansard_<name>.
# Libraries are found when a room names them in USES, and nobody else links them. How rooms are installed:
# cmake/packaging.cmake.
include(GNUInstallDirs)
include(cmake/mansard_libraries.cmake)

function(mansard_room name)
  if(MANSARD_ROOMS AND NOT name IN_LIST MANSARD_ROOMS)
    return()
  endif()
  cmake_parse_arguments(ROOM "" "" "DEPENDS;USES" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/mansard/${name}/*.cpp)
  add_library(mansard_${name} STATIC ${sources})
  add_library(mansard::${name} ALIAS mansard_${name})
  set_target_properties(mansard_${name} PROPERTIES EXPORT_NAME ${name} MANSARD_DOORS "${ROOM_DEPENDS}"
    MANSARD_USES "${ROOM_USES}")
  set_property(GLOBAL APPEND PROPERTY MANSARD_ROOM_LIST ${name})  # in the order of the house
  if(NOT PROJECT_IS_TOP_LEVEL AND NOT MANSARD_INSTALL)  # another project builds what it links
    set_target_properties(mansard_${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
  endif()
  target_compile_features(mansard_${name} PUBLIC cxx_std_20)
  target_include_directories(mansard_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  foreach(door IN LISTS ROOM_DEPENDS)
    if(NOT TARGET mansard_${door})
      message(FATAL_ERROR "MANSARD_ROOMS lacks ${door}, which ${name} stands on")
    endif()
    target_link_libraries(mansard_${name} PUBLIC mansard_${door})
  endforeach()
  foreach(library IN LISTS ROOM_USES)
    mansard_find_library(${library} REQUIRED)
    if(NOT TARGET ${MANSARD_LIBRARY_TARGET})
      message(FATAL_ERROR "${library} was found without the target ${MANSARD_LIBRARY_TARGET}")
    endif()
    if(${library} IN_LIST MANSARD_HEADERS_ONLY)  # those who link the room do not need them
      target_link_libraries(mansard_${name} PRIVATE $<BUILD_INTERFACE:${MANSARD_LIBRARY_TARGET}>)
    else()
      target_link_libraries(mansard_${name} PRIVATE ${MANSARD_LIBRARY_TARGET})
    endif()
  endforeach()
  mansard_precompiled(mansard_${name} rooms)
endfunction()
