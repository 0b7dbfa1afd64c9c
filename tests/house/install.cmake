# Installs the extrusion kernel and uses it from a project outside: it must build, run, and need nothing else of ours.
#   cmake -DROOT=<repository> -DBUILD=<its build> -DSCRATCH=<folder> [-DCOMPILER=… -DFLAGS=…] -P install.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${SCRATCH})

function(run expected)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  list(JOIN ARGN " " command)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${command}\nended with ${code}:\n${output}")
  endif()
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${command}\ndid not say '${expected}':\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# ---- what is installed: three libraries with their doors, the package, the licence
set(prefix ${SCRATCH}/prefix)
run("" ${CMAKE_COMMAND} --install ${BUILD} --component extrude --prefix ${prefix})
file(GLOB_RECURSE installed RELATIVE ${prefix} ${prefix}/*)
set(complaints "")
foreach(wanted IN ITEMS include/mansard/extrude/extrude.hpp include/mansard/geometry/plan.hpp
    include/mansard/base/result.hpp "libmansard_extrude[.]a" "libmansard_geometry[.]a" "libmansard_base[.]a"
    mansardConfig.cmake mansardConfigVersion.cmake "/LICENSE" "/NOTICE")
  if(NOT installed MATCHES "${wanted}")
    list(APPEND complaints "${wanted} is not installed")
  endif()
endforeach()
foreach(file IN LISTS installed)
  if(file MATCHES "/detail/" OR NOT file MATCHES
      "^(include/mansard/(base|geometry|extrude)/|lib.*/libmansard_(base|geometry|extrude)[.]a$|lib.*/cmake/mansard/|share/doc/mansard/)")
    list(APPEND complaints "${file} is installed and should not be")
  endif()
endforeach()
if(complaints)
  list(JOIN complaints "\n  " text)
  message(FATAL_ERROR "the installed files are not those of the kernel:\n  ${text}\n")
endif()

# ---- a project that finds it, builds and runs
set(outside ${SCRATCH}/consumer)
file(COPY ${ROOT}/tests/house/consumer DESTINATION ${SCRATCH})
run("" ${CMAKE_COMMAND} -S ${outside} -B ${outside}/build -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_BUILD_TYPE=Release)
run("" ${CMAKE_COMMAND} --build ${outside}/build)
run("7 faces, 640[.]0 m3" ${outside}/build/house)

# ---- the libraries it is linked with: ours are inside, so the rest is what the kernel needs
run("libgmp" ldd ${outside}/build/house)
foreach(library IN ITEMS gdal embree Cbc Clp png crypto tinygltf CGAL)
  if(output MATCHES "lib${library}")
    message(FATAL_ERROR "the kernel drags in lib${library}:\n${output}")
  endif()
endforeach()

# ---- and a component that is not installed is refused
file(READ ${outside}/CMakeLists.txt lists)
string(REPLACE "COMPONENTS extrude" "COMPONENTS segment" lists "${lists}")
file(WRITE ${outside}/CMakeLists.txt "${lists}")
execute_process(COMMAND ${CMAKE_COMMAND} -S ${outside} -B ${outside}/build
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(code EQUAL 0)
  message(FATAL_ERROR "a component that is not installed was found")
endif()
file(REMOVE_RECURSE ${SCRATCH})
