// The functions of the module: what the command line's verbs do, with Python's values in and out.
#pragma once

#include <pybind11/pybind11.h>

namespace mansard::python {

void bind_functions(pybind11::module_& m);

}  // namespace mansard::python
