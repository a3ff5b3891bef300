#include "engine/record/recording.h"
#include "engine/record/recording_file.h"
#include "tools/python/module.h"

namespace loopwright::python {
namespace {

namespace py = pybind11;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A view of a column, without a copy. It keeps the recording alive and is read-only, because the recording
/// states which run computed it.
py::array view(const py::object& owner, const Column& column) {
  py::array_t<double> array({column.values.size()}, {sizeof(double)}, column.values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

const Column& column_of(const Recording& recording, const std::string& name) {
  if (const Column* found = recording.find(name)) return *found;
  std::vector<std::string> names;
  for (const Column& column : recording.columns) names.push_back(column.name);
  const std::string nearest = nearest_name(name, names);
  throw py::key_error(name +
                      (nearest.empty() ? " is no column" : " is no column; did you mean " + nearest + "?"));
}

Recording from_columns(const std::vector<std::string>& names, const std::vector<std::string>& units,
                       const std::vector<Numbers>& values) {
  if (names.size() != units.size() || names.size() != values.size())
    throw py::value_error("as many names as units and columns");
  Recording recording;
  for (size_t i = 0; i < names.size(); ++i) {
    if (values[i].ndim() != 1) throw py::value_error(names[i] + ": a column has one dimension");
    recording.columns.push_back(
        {names[i], units[i], {values[i].data(), values[i].data() + values[i].size()}, {}});
  }
  check_recording(recording);
  return recording;
}

Recording read(const std::string& path, bool allow_not_finite) {
  Problems problems;
  Recording recording = [&] {
    const py::gil_scoped_release release;
    return read_recording(path, problems, {.allow_not_finite = allow_not_finite});
  }();
  if (problems.has_errors()) throw InputError(std::move(problems));
  return recording;
}

}  // namespace

void add_recording(py::module_& module) {
  py::class_<Recording, std::shared_ptr<Recording>>(module, "Columns")
      .def(py::init(&from_columns), py::arg("names"), py::arg("units"), py::arg("values"))
      .def("__len__", [](const Recording& r) { return r.columns.size(); })
      .def("__contains__",
           [](const Recording& r, const std::string& name) { return r.find(name) != nullptr; })
      .def_property_readonly("rows", &Recording::rows)
      .def("names",
           [](const Recording& r) {
             std::vector<std::string> names;
             for (const Column& column : r.columns) names.push_back(column.name);
             return names;
           })
      .def("unit", [](const Recording& r, const std::string& name) { return column_of(r, name).unit; })
      .def("column",
           [](const py::object& self, const std::string& name) {
             return view(self, column_of(self.cast<const Recording&>(), name));
           })
      .def("facts", [](const Recording& r) { return py::dict(py::cast(r.facts)); })
      .def("save", [](const Recording& r, const std::string& path) { write_recording(path, r); });
  module.def("read", &read, py::arg("path"), py::arg("allow_not_finite"));
}

}  // namespace loopwright::python
