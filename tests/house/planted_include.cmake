# Copies the tree, plants one violation, and holds the include check to finding it, and nothing else.
#   cmake -DROOT=<repository> -DSCRATCH=<folder> -DFILE=<path in the tree> -DLINE=<text> -DEXPECT=<complaint> -P …
# The text is added to the end of the file; with -DINSTEAD_OF=<regex> it takes the place of what matches.
# Without FILE the tree is copied only, and must pass.
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE ${SCRATCH})
foreach(folder IN ITEMS cmake mansard lab apps bench tests tools)
  if(IS_DIRECTORY ${ROOT}/${folder})
    file(COPY ${ROOT}/${folder} DESTINATION ${SCRATCH}
      FILES_MATCHING PATTERN *.hpp PATTERN *.cpp PATTERN *.h PATTERN *.cmake)
  endif()
endforeach()
if(DEFINED FILE)
  if(EXISTS ${SCRATCH}/${FILE})
    file(READ ${SCRATCH}/${FILE} text)
  endif()
  if(DEFINED INSTEAD_OF)
    string(REGEX REPLACE "${INSTEAD_OF}" "${LINE}" planted "${text}")
    if(planted STREQUAL "${text}")
      message(FATAL_ERROR "${FILE} has nothing like '${INSTEAD_OF}' to replace")
    endif()
  else()
    set(planted "${text}${LINE}\n")
  endif()
  file(WRITE ${SCRATCH}/${FILE} "${planted}")
endif()

execute_process(
  COMMAND ${CMAKE_COMMAND} -DROOT=${SCRATCH} -P ${ROOT}/tools/check_includes.cmake
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
file(REMOVE_RECURSE ${SCRATCH})

if(NOT DEFINED FILE)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "the copy of the tree is refused:\n${output}")
  endif()
  return()
endif()
if(code EQUAL 0)
  message(FATAL_ERROR "the include check did not see this in ${FILE}:\n  ${LINE}")
endif()
string(FIND "${output}" "  ${EXPECT}" found)
if(found EQUAL -1)
  message(FATAL_ERROR "refused, but not with '${EXPECT}':\n${output}")
endif()
if(NOT output MATCHES "1 wrong:")
  message(FATAL_ERROR "more was refused than what was planted:\n${output}")
endif()
