// The Python module topple._core; topple/__init__.py hands its names on.
#include "bindings.h"
#include "model.h"
#include "topple/solver/blas_kernel.h"
#include "topple/structure/analysis.h"

namespace topple::python {

namespace {

template <class Names>
py::tuple tuple_of(const Names& names) {
  py::tuple all(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) all[i] = py::str(names[i]);
  return all;
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "Static analysis and interactive demolition of buildings: the compiled part of the package topple.";
  module.attr("__version__") = TOPPLE_VERSION;
  module.attr("COMPONENTS") = tuple_of(structure::component_names);
  module.attr("SENSES") = tuple_of(structure::sense_names);
  module.attr("DIAGRAMS") = tuple_of(structure::diagram_names);
  bind_errors(module);
  bind_model(module);
  bind_motion(module);
  bind_losses(module);
  bind_results(module);
  bind_analyse(module);
  bind_scenario(module);
  bind_simulation(module);
  bind_study(module);
  module.def("blas_kernel", &solver::blas_kernel, "Name of the kernels that OpenBLAS runs in this process.");
  module.def(
      "better_blas_kernel", &solver::better_blas_kernel,
      "The value of OPENBLAS_CORETYPE with which this processor should run; None when the kernels in use are "
      "already good, or the variable is set.\n\nOpenBLAS reads it when it is loaded: set it before Python starts.");
}

}  // namespace topple::python
