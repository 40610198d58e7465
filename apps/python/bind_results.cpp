// Analysis: what analyse() found, and what is written of it.
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>

#include "bindings.h"
#include "results.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/modelling_checks.h"

namespace topple::python {

using namespace structure;

namespace {

std::size_t index_of(const Analysis& analysis, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < analysis.result->combinations.size(); ++i) {
    names.push_back(analysis.building()[analysis.result->combinations[i].combination].name);
    if (names.back() == name) return i;
  }
  throw py::key_error("there is no result of a combination \"" + name + "\"" + did_you_mean(name, names));
}

py::dict statistics_of(const Analysis& analysis) {
  const solver::AnalysisStatistics& from = analysis.result->statistics;
  py::dict found;
  found["freedoms"] = from.freedoms;
  found["matrix_entries"] = from.matrix_entries;
  found["factor_entries"] = from.factor_entries;
  found["factor_operations"] = from.factor_operations;
  found["factorisation"] = from.factorisation;
  found["ordering"] = from.ordering;
  found["digits_left"] = from.digits_left;
  found["seconds"] = analysis.seconds;
  return found;
}

void write(const Analysis& analysis, const std::filesystem::path& folder, bool csv, bool vtu) {
  const py::gil_scoped_release others_run;
  NamedTexts files;
  files.emplace_back("results.json",
                     results_json(analysis.building(), analysis.request, *analysis.result, analysis.seconds));
  const auto append = [&](NamedTexts more) { std::move(more.begin(), more.end(), std::back_inserter(files)); };
  if (csv) append(results_csv(analysis.building(), *analysis.result));
  if (vtu) append(results_vtu(analysis.building(), *analysis.result));
  append(motion_csv(analysis.building(), analysis.request, *analysis.result));
  write_files(folder, files);
}

using Shared = std::shared_ptr<Analysis>;

void bind_answers(py::class_<Analysis, Shared>& analysis) {
  analysis
      .def_property_readonly(
          "model", [](const Analysis& a) { return a.model; }, "The Model that was analysed.")
      .def_property_readonly(
          "combinations",
          [](const Shared& a) {
            std::vector<CombinationView> all;
            for (std::size_t i = 0; i < a->result->combinations.size(); ++i) all.push_back({a, i});
            return all;
          },
          "A CombinationResult for each combination, in the order asked for.")
      .def(
          "__getitem__",
          [](const Shared& a, const std::string& name) {
            return CombinationView{a, index_of(*a, name)};
          },
          py::arg("combination"), "The CombinationResult of a combination by its name. Raises KeyError.")
      .def("__len__", [](const Analysis& a) { return a.result->combinations.size(); })
      .def_property_readonly(
          "mesh_positions", [](const Shared& a) { return rows_of(a->result->mesh_nodes, a); },
          "Places of the nodes of shells' meshes, shape (mesh nodes, 3), m, global axes.")
      .def_property_readonly(
          "modes", [](const Shared& a) { return parts_of<solver::VibrationMode>(a, a->result->modes); },
          "Modes of vibration (list of Mode), lowest first.")
      .def_property_readonly(
          "frequencies",
          [](const Shared& a) {
            Doubles array(static_cast<py::ssize_t>(a->result->modes.size()));
            for (std::size_t i = 0; i < a->result->modes.size(); ++i)
              array.mutable_data()[i] = a->result->modes[i].angular_frequency / (2 * M_PI);
            return array;
          },
          "Natural frequencies, shape (modes,), Hz, lowest first.")
      .def_property_readonly(
          "moving_mass", [](const Analysis& a) { return vector_of(a.result->moving_mass); },
          "Mass that is free to move along x, y, z, shape (3,), kg.")
      .def_property_readonly(
          "losses", [](const Shared& a) { return parts_of<MemberLoss>(a, a->result->losses.losses); },
          "What the sudden loss of each member does (list of Loss): mechanisms first, then by the largest utilisation.")
      .def_property_readonly(
          "motions",
          [](const Shared& a) {
            py::dict motions;
            for (const auto& [combination, motion] : a->result->motions)
              motions[py::str(a->building()[combination].name)] = MotionView{a, &motion};
            return motions;
          },
          "Motion under the time history by the name of the combination.");
}

void bind_output(py::class_<Analysis, Shared>& analysis) {
  analysis
      .def_property_readonly(
          "warnings", [](const Analysis& a) { return a.result->warnings; },
          "What to know of the answers, a sentence each.")
      .def_property_readonly(
          "unfinished", [](const Analysis& a) { return a.result->unfinished; },
          "What was asked for and not computed, and why.")
      .def_property_readonly(
          "statistics", &statistics_of,
          "Size and cost, a dict with freedoms, entries and operations of the factor, digits left, seconds by stage.")
      .def(
          "to_dict",
          [](const Analysis& a) { return json_object(results_json(a.building(), a.request, *a.result, a.seconds)); },
          "The whole result as results.json has it (docs/results-format.md), in the model's units.")
      .def("write", &write, py::arg("folder"), py::arg("csv") = false, py::arg("vtu") = false,
           "Writes results.json into a folder; tables and ParaView drawings beside it on request. Drawings need "
           "analyse(..., stations=10) or more. Raises InputError, ValueError, RuntimeError.")
      .def(
          "summary", [](const Analysis& a) { return summary_text(a.building(), *a.result, a.seconds); },
          "The summary that the command prints.")
      .def(
          "plot",
          [](const py::object& self, const py::args& args, const py::kwargs& options) {
            return py::module_::import("topple.plot").attr("analysis")(self, *args, **options);
          },
          "Draws the deformed shape or a diagram: topple.plot.analysis(analysis, ...).")
      .def("__repr__", [](const Analysis& a) {
        return "<topple.Analysis of \"" + a.building().title + "\": " + std::to_string(a.result->combinations.size()) +
               " combinations, " + std::to_string(a.result->statistics.freedoms) + " freedoms>";
      });
}

void bind_modes(py::module_& module) {
  py::class_<ModeView>(module, "Mode", "A mode of vibration.")
      .def_property_readonly(
          "frequency", [](const ModeView& m) { return m.get().angular_frequency / (2 * M_PI); }, "Hz.")
      .def_property_readonly(
          "angular_frequency", [](const ModeView& m) { return m.get().angular_frequency; }, "rad/s.")
      .def_property_readonly(
          "mass_share", [](const ModeView& m) { return vector_of(m.get().mass_share); },
          "Effective mass along x, y, z and moment of inertia about them, as a share of what can move, shape (6,).")
      .def_property_readonly(
          "shape", [](const ModeView& m) { return rows_of(m.get().shape, m.owner()); },
          "The shape, shape (nodes, 6), x y z rx ry rz, global axes; largest translation 1.");
  py::class_<BucklingView>(module, "BucklingMode", "A way in which the structure buckles.")
      .def_property_readonly(
          "factor", [](const BucklingView& m) { return m.get().factor; },
          "By which the loads may grow until it happens.")
      .def_property_readonly(
          "shape", [](const BucklingView& m) { return rows_of(m.get().shape, m.owner()); },
          "The shape, shape (nodes, 6), x y z rx ry rz, global axes; largest translation 1, all 0 where a member "
          "buckles between "
          "nodes at rest.");
}

}  // namespace

void bind_results(py::module_& module) {
  bind_modes(module);
  bind_combination(module);
  py::class_<Analysis, Shared> analysis(module, "Analysis", "What analyse() found.");
  bind_answers(analysis);
  bind_output(analysis);
}

}  // namespace topple::python
