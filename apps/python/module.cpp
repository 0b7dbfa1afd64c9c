// The extension module mansard._core. Its functions take plain values; the package around it takes what users have.
#include <pybind11/pybind11.h>

#include "apps/python/city.hpp"
#include "apps/python/functions.hpp"
#include "apps/python/settings.hpp"

PYBIND11_MODULE(_core, m) {
  m.doc() = "The engine of mansard.";
  m.attr("__version__") = MANSARD_VERSION;
  mansard::python::bind_settings(m);
  mansard::python::bind_city(m);
  mansard::python::bind_functions(m);
}
