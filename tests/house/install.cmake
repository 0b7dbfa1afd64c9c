# Installs modules and uses them from a project outside: it must build, run, and need nothing that it did not ask for.
#   cmake -DROOT=<repository> -DBUILD=<its build> -DSCRATCH=<folder> [-DCOMPILER=… -DFLAGS=…] -DWHAT=kernel|engine
#     -P install.cmake
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

# The installed files have each of `wanted`, and no other module's.
function(expect_installed modules wanted)
  file(GLOB_RECURSE installed RELATIVE ${prefix} ${prefix}/*)
  set(complaints "")
  foreach(file IN LISTS wanted)
    if(NOT installed MATCHES "${file}")
      list(APPEND complaints "${file} is not installed")
    endif()
  endforeach()
  foreach(file IN LISTS installed)
    if(file MATCHES "/detail/" OR NOT file MATCHES
        "^(include/mansard/(${modules})/|lib.*/libmansard_(${modules})[.]a$|lib.*/cmake/mansard/(mansardConfig|mansardConfigVersion|mansard_libraries|mansard_(${modules})|mansard_(${modules})-[a-z]+)[.]cmake$|share/doc/libmansard-dev/)")
      list(APPEND complaints "${file} is installed and should not be")
    endif()
  endforeach()
  if(complaints)
    list(JOIN complaints "\n  " text)
    message(FATAL_ERROR "the installed files are not those of the ${WHAT}:\n  ${text}\n")
  endif()
endfunction()

# Configures and builds tests/house/<project> as a project of its own.
function(build_outside project)
  file(COPY ${ROOT}/tests/house/${project} DESTINATION ${SCRATCH})
  set(outside ${SCRATCH}/${project} PARENT_SCOPE)
  run("" ${CMAKE_COMMAND} -S ${SCRATCH}/${project} -B ${SCRATCH}/${project}/build -G Ninja
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS}
    -DCMAKE_BUILD_TYPE=Release ${ARGN})
  run("" ${CMAKE_COMMAND} --build ${SCRATCH}/${project}/build)
endfunction()

set(prefix ${SCRATCH}/prefix)
run("" ${CMAKE_COMMAND} --install ${BUILD} --component extrude --prefix ${prefix})

if(WHAT STREQUAL "kernel")
  expect_installed("base|geometry|model|solid|extrude" "include/mansard/extrude/extrude.hpp;include/mansard/model/plan.hpp;\
include/mansard/base/result.hpp;libmansard_extrude[.]a;libmansard_geometry[.]a;libmansard_base[.]a;\
mansardConfig.cmake;mansardConfigVersion.cmake;/LICENSE;/NOTICE")
  build_outside(consumer)
  run("7 faces, 640[.]0 m3" ${outside}/build/house)

  # The libraries it is linked with: ours are inside, so the rest is what the kernel needs.
  run("libgmp" ldd ${outside}/build/house)
  foreach(library IN ITEMS gdal embree Cbc Clp png crypto tinygltf CGAL)
    if(output MATCHES "lib${library}")
      message(FATAL_ERROR "the kernel drags in lib${library}:\n${output}")
    endif()
  endforeach()

  # And a component that is not installed is refused.
  file(READ ${outside}/CMakeLists.txt lists)
  string(REPLACE "COMPONENTS extrude" "COMPONENTS segment" lists "${lists}")
  file(WRITE ${outside}/CMakeLists.txt "${lists}")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${outside} -B ${outside}/build
    RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(code EQUAL 0)
    message(FATAL_ERROR "a component that is not installed was found")
  endif()
elseif(WHAT STREQUAL "engine")
  run("" ${CMAKE_COMMAND} --install ${BUILD} --component engine --prefix ${prefix})
  file(READ ${ROOT}/cmake/modules.cmake list)
  string(REGEX REPLACE "#[^\n]*" "" list "${list}")
  string(REGEX REPLACE "mansard_module[(][a-z_]+ +IN [^)]*[)]" "" list "${list}")  # not installed
  string(REGEX MATCHALL "mansard_module[(][a-z_]+" calls "${list}")
  set(modules "")
  set(wanted "")
  foreach(call IN LISTS calls)
    string(REPLACE "mansard_module(" "" module ${call})
    list(APPEND modules ${module})
    list(APPEND wanted "libmansard_${module}[.]a" "include/mansard/${module}/[a-z_]+[.]hpp" "mansard_${module}[.]cmake")
  endforeach()
  list(JOIN modules "|" modules)
  expect_installed("${modules}" "${wanted}")
  build_outside(consumer_engine)

  # The hall of the samples, as its footprints have it: two buildings.
  run("2 buildings, [1-9][0-9][0-9]+[.][0-9] m3" ${outside}/build/street ${ROOT}/data/hall/mesh.off
    ${ROOT}/data/hall/footprints.geojson)

  # The kernel's consumer asks the same package for less, and gets less.
  build_outside(consumer)
  run("GDAL" ${CMAKE_COMMAND} -LA -N ${SCRATCH}/consumer_engine/build)
  run("" ${CMAKE_COMMAND} -LA -N ${SCRATCH}/consumer/build)
  if(output MATCHES "GDAL|embree|CBC|PNG")
    message(FATAL_ERROR "who asks for the kernel alone is made to look for other libraries:\n${output}")
  endif()

  # A library that is missing is named, with its package.
  file(READ ${prefix}/lib/cmake/mansard/mansard_libraries.cmake libraries)
  string(REPLACE "find_package(PNG" "find_package(NoSuchPNG" libraries "${libraries}")
  file(WRITE ${prefix}/lib/cmake/mansard/mansard_libraries.cmake "${libraries}")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SCRATCH}/consumer_engine -B ${SCRATCH}/consumer_engine/lacks -G Ninja
    -DCMAKE_PREFIX_PATH=${prefix} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(code EQUAL 0 OR NOT output MATCHES "needs PNG::PNG; in[ \n]+Debian[ \n]+it[ \n]+is[ \n]+in[ \n]+libpng-dev")
    message(FATAL_ERROR "a missing library is not named with its package:\n${output}")
  endif()
else()
  message(FATAL_ERROR "-DWHAT=kernel or -DWHAT=engine")
endif()
file(REMOVE_RECURSE ${SCRATCH})
