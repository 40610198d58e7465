#pragma once
// The parts of Simulation that lie in files of their own.
#include <filesystem>

#include "simulation.h"

namespace topple::python {

using BoundSimulation = py::class_<SimulationHost, std::shared_ptr<SimulationHost>>;

void bind_body(py::module_& module);
void bind_standing(BoundSimulation& simulation);
void bind_tools(BoundSimulation& simulation);

[[nodiscard]] py::list bodies_of(SimulationHost& host);
[[nodiscard]] py::object summary_of(SimulationHost& host);
[[nodiscard]] py::object standing_of(SimulationHost& host);
[[nodiscard]] std::string text_of(SimulationHost& host);
void write_to(SimulationHost& host, const std::filesystem::path& folder);

}  // namespace topple::python
