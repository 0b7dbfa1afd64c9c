# GMP::gmpxx: GMP and its C++ interface, which come without a CMake package. Also installed, beside mansardConfig.cmake.
if(NOT TARGET GMP::gmpxx)
  find_library(GMP_LIBRARY gmp REQUIRED)
  find_library(GMPXX_LIBRARY gmpxx REQUIRED)
  add_library(GMP::gmpxx INTERFACE IMPORTED)
  target_link_libraries(GMP::gmpxx INTERFACE ${GMPXX_LIBRARY} ${GMP_LIBRARY})
endif()
