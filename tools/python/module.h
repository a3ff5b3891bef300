/// The Python module: a face over the functions that the commands call. It has no logic of its own.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace loopwright::python {

void add_errors(pybind11::module_& module);
void add_recording(pybind11::module_& module);
void add_diagram(pybind11::module_& module);
void add_stepper(pybind11::module_& module);
void add_answers(pybind11::module_& module);

}  // namespace loopwright::python
