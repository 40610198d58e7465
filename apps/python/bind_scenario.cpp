// Scenario: what happens to a building.
#include "bindings.h"
#include "simulation.h"

namespace topple::python {

using namespace structure;

void bind_scenario(py::module_& module) {
  py::class_<Scene, std::shared_ptr<Scene>>(
      module, "Scenario", "What happens to a building: rules of failure, impact and debris, and tools at their times.")
      .def(py::init([](const py::object& source, const py::object& model) {
             return std::const_pointer_cast<Scene>(scene_of(source, model));
           }),
           py::arg("source"), py::arg("model") = py::none(),
           "Reads a scenario, which is a shipped one's name (\"seed_hit\"), a path, a dict with the keys of the "
           "scenario "
           "format (docs/scenario-format.md), or a Model to which nothing happens.\n\n"
           "model: with a dict, the Model (or what Model() takes) that it is about; else the dict's key `model` is a "
           "shipped model's name, a path, a Model or a dict.\n\nRaises InputError with the place, TypeError.")
      .def_property_readonly(
          "model", [](const Scene& s) { return s.model; },
          "The Model, with its members divided where the scenario cuts them.")
      .def_property_readonly(
          "title", [](const Scene& s) { return s.scenario.title; }, "The scenario's title.")
      .def_property_readonly(
          "file", [](const Scene& s) { return s.scenario.file; }, "What it was read from, as messages call it.")
      .def_property_readonly(
          "combination",
          [](const Scene& s) -> std::string {
            return s.scenario.combination ? s.model->building()[*s.scenario.combination].name : std::string();
          },
          "Name of the combination of loads that act.")
      .def_property_readonly(
          "step_length", [](const Scene& s) { return s.scenario.step; }, "Length of a step, s.")
      .def_property_readonly(
          "duration", [](const Scene& s) { return s.scenario.duration; }, "Simulated time, s.")
      .def_property_readonly(
          "event_times",
          [](const Scene& s) {
            std::vector<double> times;
            for (const Event& event : s.scenario.events) times.push_back(event.at);
            return times;
          },
          "When its tools act, s, ascending.")
      .def("__repr__", [](const Scene& s) {
        return "<topple.Scenario \"" + s.scenario.title + "\": " + std::to_string(s.scenario.events.size()) +
               " events>";
      });
}

}  // namespace topple::python
