#pragma once
// One function for each file of bindings; module.cpp calls them in this order.
#include <pybind11/pybind11.h>

namespace topple::python {

void bind_errors(pybind11::module_& module);
void bind_model(pybind11::module_& module);
void bind_motion(pybind11::module_& module);
void bind_losses(pybind11::module_& module);
void bind_results(pybind11::module_& module);
void bind_analyse(pybind11::module_& module);
void bind_scenario(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_study(pybind11::module_& module);

}  // namespace topple::python
