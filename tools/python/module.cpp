#include "tools/python/module.h"
#include "engine/record/installation.h"

PYBIND11_MODULE(_core, module) {
  using namespace loopwright;
  module.doc() = "Functions of Loopwright; the package loopwright presents them.";
  module.def("set_prefix", &set_prefix, pybind11::arg("prefix"));
  python::add_errors(module);
  python::add_recording(module);
  python::add_diagram(module);
  python::add_stepper(module);
  python::add_answers(module);
}
