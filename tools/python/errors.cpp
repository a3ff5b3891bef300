#include "engine/json/problem.h"
#include "tools/python/module.h"

namespace loopwright::python {
namespace {

namespace py = pybind11;

/// loopwright.InputError, created once; kept for the lifetime of the process.
PyObject* input_error_type = nullptr;

std::string file_of(const Problem& problem) { return problem.place.file ? problem.place.file->name : ""; }
LineColumn position_of(const Problem& problem) {
  return problem.place.file ? line_column(problem.place) : LineColumn{0, 0};
}

void raise(const InputError& error) {
  const py::object exception = py::reinterpret_borrow<py::object>(input_error_type)(error.what());
  exception.attr("problems") = py::cast(error.problems.list());
  PyErr_SetObject(input_error_type, exception.ptr());
}

}  // namespace

void add_errors(py::module_& module) {
  py::class_<Problem>(module, "Problem")
      .def_property_readonly(
          "severity",
          [](const Problem& p) { return p.severity == Problem::Severity::error ? "error" : "warning"; })
      .def_property_readonly("file", &file_of)
      .def_property_readonly("line", [](const Problem& p) { return position_of(p).line; })
      .def_property_readonly("column", [](const Problem& p) { return position_of(p).column; })
      .def_property_readonly(
          "pointer", [](const Problem& p) { return p.pointer.empty() ? p.place.pointer() : p.pointer; })
      .def_readonly("block", &Problem::block)
      .def_readonly("message", &Problem::message)
      .def_readonly("expected", &Problem::expected)
      .def_readonly("found", &Problem::found)
      .def_readonly("hint", &Problem::hint)
      .def("__str__", [](const Problem& p) { return to_string(p); })
      .def("__repr__", [](const Problem& p) { return "<loopwright.Problem " + to_string(p) + ">"; });

  input_error_type = PyErr_NewExceptionWithDoc(
      "loopwright.InputError",
      "A file or an argument is wrong. The message tells every problem; `problems` lists them.",
      PyExc_ValueError, nullptr);
  if (!input_error_type) throw py::error_already_set();
  module.attr("InputError") = py::reinterpret_borrow<py::object>(input_error_type);
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const InputError& error) {
      raise(error);
    }
  });
}

}  // namespace loopwright::python
