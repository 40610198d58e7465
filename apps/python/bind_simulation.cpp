// Simulation: stepping, poses, events, accounts.
#include <pybind11/stl/filesystem.h>

#include <limits>

#include "arrays.h"
#include "bindings.h"
#include "simulation.h"
#include "simulation_bindings.h"
#include "topple/structure/number_range.h"

namespace topple::python {

using namespace structure;

namespace {

Doubles poses_of(SimulationHost& host) {
  return host.with([](Simulation& s) {
    const std::shared_ptr<const std::vector<double>> poses = s.held_poses();
    return view_of(poses->data(), {static_cast<py::ssize_t>(poses->size() / 7), 7},
                   {7 * sizeof(double), sizeof(double)}, poses);
  });
}

Handles handles_of(SimulationHost& host) {
  return host.with([](Simulation& s) {
    Handles array(static_cast<py::ssize_t>(s.bodies().size()));
    std::int64_t* out = array.mutable_data();
    for (const BodyView& body : s.bodies()) *out++ = body.id.value;
    return array;
  });
}

py::dict changes_of(SimulationHost& host) {
  return host.with([](Simulation& s) {
    const PieceChanges& changes = s.changes();
    py::dict found;
    found["made"] = copied<std::int64_t>(changes.made);
    found["gone"] = copied<std::int64_t>(changes.gone);
    found["moved"] = copied<std::int64_t>(changes.moved);
    Handles split({changes.split.size(), std::size_t{2}});
    std::int64_t* out = split.mutable_data();
    for (const PieceChanges::Split& one : changes.split) {
      *out++ = one.from;
      *out++ = one.to;
    }
    found["split"] = split;
    return found;
  });
}

py::dict ledger_of(SimulationHost& host) {
  const Ledger ledger = host.compute([](Simulation& s) { return s.ledger(); });
  py::dict found;
  for (const auto& [name, value] : ledger_entries(ledger)) found[name] = value;
  return found;
}

py::bytes save(SimulationHost& host) {
  return host.compute([](Simulation& s) { return snapshot_bytes(s.save()); });
}

void restore(SimulationHost& host, const py::bytes& snapshot) {
  const std::string bytes = snapshot;
  host.compute([&](Simulation& s) { s.restore(parse_snapshot(bytes, "snapshot")); });
}

using Bound = BoundSimulation;

void bind_stepping(Bound& simulation) {
  simulation
      .def(py::init([](const py::object& scenario, int threads) {
             const std::shared_ptr<const Scene> scene = scene_of(scenario, py::none());
             const py::gil_scoped_release others_run;
             return std::make_shared<SimulationHost>(scene, threads);
           }),
           py::arg("scenario"), py::kw_only(), py::arg("threads") = 1,
           "Begins a simulation of a Scenario, or of what Scenario() takes.\n\n"
           "threads: of the solver; it changes no bit. Raises InputError, UnstableModel.")
      .def(
          "step",
          [](SimulationHost& host, std::int64_t count) {
            if (count < 0)
              throw py::value_error("step: found " + std::to_string(count) + "; accepted: 0 or more steps");
            return host.advance(count, std::nullopt, false);
          },
          py::arg("count") = 1,
          "Makes steps of Scenario.step_length, beyond the scenario's duration too. Returns what happened, as "
          "`events` has it. Other Python threads run meanwhile.")
      .def(
          "run",
          [](SimulationHost& host, std::optional<double> until) {
            constexpr NumberRange times{0, ranges::session.most};
            if (until) require_in(times, *until, "until");
            return host.advance(std::numeric_limits<std::int64_t>::max(), until, true);
          },
          py::arg("until") = py::none(),
          "Steps to a time (s), or until the run is finished, over idle time at once. Returns what happened, as "
          "`events` has it. Ctrl-C ends it between two steps. Raises InputError.")
      .def_property_readonly(
          "finished", [](SimulationHost& h) { return h.with([](Simulation& s) { return s.finished(); }); },
          "True when the duration is over, or all is at rest and nothing is to come.")
      .def_property_readonly(
          "at_rest", [](SimulationHost& h) { return h.with([](Simulation& s) { return s.at_rest(); }); },
          "True when nothing moves, breaks or is to come.")
      .def_property_readonly(
          "time", [](SimulationHost& h) { return h.with([](Simulation& s) { return s.time(); }); },
          "Simulated time, s.")
      .def_property_readonly(
          "steps", [](SimulationHost& h) { return h.with([](Simulation& s) { return s.steps(); }); },
          "Steps made, those passed over included.")
      .def_property_readonly(
          "scenario", [](SimulationHost& h) { return std::const_pointer_cast<Scene>(h.shared_scene()); },
          "The Scenario.")
      .def_property_readonly(
          "model", [](SimulationHost& h) { return h.scene().model; },
          "The Model, with its members divided where the scenario cuts them.")
      .def(
          "on_event", [](SimulationHost& h, const py::function& listener) { h.listen(listener); }, py::arg("listener"),
          "Calls listener(event) with each event (a dict, as in `events`) at the end of its step, from step() and "
          "run(). "
          "It may use the simulation. What it raises ends the step() or run() after that step.")
      .def("save", &save, "This moment as bytes, which restore() comes back to; it holds what was done and when.")
      .def("restore", &restore, py::arg("snapshot"),
           "Comes back to a moment of the same model and scenario, exact to the bit, at the cost of the way there. "
           "Raises "
           "InputError, and then all is as before.");
}

void bind_bodies(Bound& simulation) {
  simulation
      .def_property_readonly(
          "poses", &poses_of,
          "Poses of all bodies, shape (bodies, 7), position x y z (m) of the centre of mass and orientation as a "
          "quaternion x y z w; rows as `handles` and `bodies`. A read-only view without a copy: it stays as it is "
          "while steps go on, so ask again after each.")
      .def_property_readonly("handles", &handles_of,
                             "Handles of the bodies, shape (bodies,), never used again. A new array.")
      .def_property_readonly("bodies", &bodies_of,
                             "What moves (list of Body), debris of the building and balls, as they are now.")
      .def_property_readonly(
          "changes", &changes_of,
          "Handles of what the last step made, took away (gone), moved, and split, the last of shape "
          "(pieces, 2) from and to.")
      .def_property_readonly(
          "events", [](SimulationHost& h) { return h.with([&](Simulation&) { return h.events(); }); },
          "What happened so far, a list of dicts with the keys of events.jsonl (docs/results-format.md), time and kind "
          "always.");
}

void bind_accounts(Bound& simulation) {
  simulation
      .def_property_readonly("ledger", &ledger_of, "Energies, J, each measured on its own, and the residual (a share).")
      .def_property_readonly(
          "hash", [](SimulationHost& h) { return h.compute([](Simulation& s) { return s.hash(); }); },
          "Of the state to the bit; the same for the same scenario in every run.")
      .def("summary", &summary_of, "What came of it, with the keys of summary.json (docs/results-format.md).")
      .def("standing", &standing_of, "What stands, with the keys of standing.json (docs/results-format.md).")
      .def("text", &text_of, "The summary that the command prints.")
      .def("write", &write_to, py::arg("folder"),
           "Writes events.jsonl, summary.json and standing.json into a folder. Raises InputError, RuntimeError.")
      .def(
          "plot",
          [](const py::object& self, const py::args& args, const py::kwargs& options) {
            return py::module_::import("topple.plot").attr("simulation")(self, *args, **options);
          },
          "Draws what stands and what lies: topple.plot.simulation(simulation, ...).")
      .def("__repr__", [](SimulationHost& h) {
        return h.with([&](Simulation& s) {
          return "<topple.Simulation \"" + s.scenario().title + "\" at " + std::to_string(s.time()) + " s, " +
                 std::to_string(s.bodies().size()) + " bodies>";
        });
      });
}

}  // namespace

void bind_simulation(py::module_& module) {
  bind_body(module);
  Bound simulation(module, "Simulation",
                   "A building that is demolished, step by step. One thread uses it at a time; others wait.");
  bind_stepping(simulation);
  bind_bodies(simulation);
  bind_standing(simulation);
  bind_tools(simulation);
  bind_accounts(simulation);
}

}  // namespace topple::python
