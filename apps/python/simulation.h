#pragma once
// The Python classes Scenario and Simulation.
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "model.h"
#include "topple/structure/collapse_report.h"
#include "topple/structure/scenario.h"
#include "topple/structure/simulation.h"

namespace topple::python {

/// What happens to a building, and the building, with its members divided where they are cut.
struct Scene {
  std::shared_ptr<Model> model;
  structure::Scenario scenario;
};

/// A scenario itself, or what Scenario() takes.
[[nodiscard]] std::shared_ptr<const Scene> scene_of(const py::object& source, const py::object& model);

/// A simulation that one thread uses at a time: others wait for it without holding the interpreter.
class SimulationHost {
 public:
  SimulationHost(std::shared_ptr<const Scene> scene, int threads);

  /// Calls `use` with the simulation for this thread alone.
  template <class Use>
  auto with(Use use) {
    const Lock lock(guard_);
    return use(simulation_);
  }
  /// The same without the interpreter, for what takes long.
  template <class Use>
  auto compute(Use use) {
    const Lock lock(guard_);
    const py::gil_scoped_release others_run;
    return use(simulation_);
  }

  /// Steps, at most `most` of them and up to the time `until`; `skip`: over idle time at once. Returns the events of
  /// these steps, after the listeners have heard them.
  py::list advance(std::int64_t most, std::optional<double> until, bool skip);
  /// All events so far, as dicts.
  [[nodiscard]] py::list events() const { return events_from(0); }
  void listen(py::object listener) { listeners_.push_back(std::move(listener)); }
  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const std::shared_ptr<const Scene>& shared_scene() const { return scene_; }
  [[nodiscard]] const structure::Building& building() const { return scene_->model->building(); }
  [[nodiscard]] const structure::StepTimes& times() const { return times_; }
  [[nodiscard]] double roof_sag() const { return roof_sag_; }

 private:
  /// A thread that waits lets go of the interpreter. A listener may come back to the simulation that it hears.
  class Lock {
   public:
    explicit Lock(std::recursive_mutex& guard);
    ~Lock() { guard_.unlock(); }
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

   private:
    std::recursive_mutex& guard_;
  };

  std::int64_t steps_until_event(std::int64_t most, std::optional<double> until, bool skip);
  py::list events_from(std::size_t first) const;

  std::shared_ptr<const Scene> scene_;
  structure::Simulation simulation_;
  structure::StepTimes times_;
  double roof_sag_ = 0;
  std::vector<py::object> listeners_;
  std::recursive_mutex guard_;
};

}  // namespace topple::python
