// Scenario and Simulation without their bindings: reading, stepping, locking.
#include "simulation.h"

#include <chrono>

#include "errors.h"
#include "host_blas.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/scenario_text.h"
#include "topple/structure/join_shells.h"

namespace topple::python {

using namespace structure;

namespace {

std::shared_ptr<const Scene> share(std::pair<Building, Scenario> read) {
  return std::make_shared<const Scene>(Scene{std::make_shared<Model>(std::move(read.first)), std::move(read.second)});
}

std::shared_ptr<const Scene> scene_of_dict(const py::dict& given, const py::object& model) {
  const py::dict source = given.attr("copy")();
  std::shared_ptr<Model> building;
  if (!model.is_none())
    building = model_of(model);
  else if (source.contains("model") && !py::isinstance<py::str>(source["model"]))
    building = model_of(source["model"]);
  if (building) source["model"] = building->building().file;
  const std::string text = json_text(source);
  const py::gil_scoped_release others_run;
  return read_from_objects("scenario", [&] {
    return share(building ? parse_scenario(text, "scenario", building->building())
                          : parse_scenario(text, "scenario", std::filesystem::path()));
  });
}

}  // namespace

std::shared_ptr<const Scene> scene_of(const py::object& source, const py::object& model) {
  if (py::isinstance<Scene>(source)) return source.cast<std::shared_ptr<Scene>>();
  if (const auto path = path_of(source)) {
    if (!model.is_none()) throw py::type_error("Scenario: a file names its model itself; accepted: model=None");
    const py::gil_scoped_release others_run;
    return share(read_scenario(find_scenario(*path)));
  }
  if (py::isinstance<Model>(source)) {  // nothing happens to it
    Building building = source.cast<std::shared_ptr<Model>>()->building();
    join_shells(building);
    Scenario idle = idle_scenario(building);
    return share({std::move(building), std::move(idle)});
  }
  if (!py::isinstance<py::dict>(source))
    throw py::type_error("Scenario: found " + std::string(py::str(source.get_type().attr("__name__"))) +
                         "; accepted: a shipped scenario's name, a path, a dict in the scenario format, a Model");
  return scene_of_dict(source, model);
}

SimulationHost::Lock::Lock(std::recursive_mutex& guard) : guard_(guard) {
  if (guard_.try_lock()) return;
  const py::gil_scoped_release others_run;
  guard_.lock();
}

SimulationHost::SimulationHost(std::shared_ptr<const Scene> scene, int threads)
    : scene_(std::move(scene)),
      simulation_(scene_->model->building(), scene_->scenario, {threads, {}}),
      roof_sag_(simulation_.frame().roof_sag()) {}

/// Without the interpreter: up to the next event, or for as long as a person may wait for Ctrl-C to be heard.
std::int64_t SimulationHost::steps_until_event(std::int64_t most, std::optional<double> until, bool skip) {
  constexpr std::chrono::milliseconds patience{50};
  constexpr double rounding = 1e-9;  // s: a time counts as reached this much early
  const HostBlas host;
  const auto start = std::chrono::steady_clock::now();
  const std::size_t told = simulation_.events().size();
  std::int64_t made = 0;
  while (made < most && simulation_.events().size() == told) {
    if (until ? simulation_.time() >= *until - rounding : skip && simulation_.finished()) break;
    if (skip && !until) simulation_.skip_idle();
    const std::uint64_t idle = simulation_.counters().steps_idle;
    simulation_.step();
    if (simulation_.counters().steps_idle == idle) times_.add(simulation_);
    ++made;
    if (std::chrono::steady_clock::now() - start > patience) break;
  }
  return made;
}

py::list SimulationHost::events_from(std::size_t first) const {
  std::string lines;
  for (const SimulationEvent& event : simulation_.events().subspan(first))
    lines += (lines.empty() ? "[" : ",") + event_line(simulation_.building(), event);
  return lines.empty() ? py::list() : py::list(json_object(lines + "]"));
}

py::list SimulationHost::advance(std::int64_t most, std::optional<double> until, bool skip) {
  const Lock lock(guard_);
  const std::size_t first = simulation_.events().size();
  while (true) {
    const std::size_t told = simulation_.events().size();
    std::int64_t made = 0;
    {
      const py::gil_scoped_release others_run;
      made = steps_until_event(most, until, skip);
    }
    if (!listeners_.empty() && simulation_.events().size() > told) {
      const std::vector<py::object> listeners = listeners_;  // one may add another
      for (const py::handle event : events_from(told))
        for (const py::object& listener : listeners) listener(event);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    most -= made;
    if (made == 0 || most == 0) return events_from(first);
  }
}

}  // namespace topple::python
