// Analysis and CombinationResult: everything that an analysis found, as arrays.
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

using Combination = py::class_<CombinationView>;

template <class Get>
Doubles of_members(const CombinationView& c, Get get, const Shape& inner = {}, const Shape& strides = {}) {
  return field_of<MemberResult, double>(c.get().members, get, c.owner(), inner, strides);
}
template <class Get>
Doubles of_panels(const CombinationView& c, Get get, const Shape& inner, const Shape& strides) {
  return field_of<PanelResult, double>(c.get().panels, get, c.owner(), inner, strides);
}

int diagram_index(const std::string& name) {
  for (std::size_t i = 0; i < diagram_names.size(); ++i)
    if (name == diagram_names[i]) return static_cast<int>(i);
  std::string accepted;
  for (const char* known : diagram_names) accepted += (accepted.empty() ? "" : ", ") + std::string(known);
  throw py::value_error("there is no diagram \"" + name + "\"; accepted: " + accepted);
}

std::size_t stations_of(const CombinationView& c) {
  const std::size_t stations = c.get().members.empty() ? 0 : c.get().members.front().stations.size();
  if (stations == 0) throw py::value_error("the analysis has no stations; accepted: analyse(..., stations=20)");
  return stations;
}

Doubles diagram(const CombinationView& c, const std::string& name) {
  const auto which = static_cast<std::size_t>(diagram_index(name));
  const std::size_t stations = stations_of(c);
  const auto& members = c.get().members;
  Doubles array({members.size(), stations});
  double* out = array.mutable_data();
  for (const MemberResult& member : members)
    for (const auto& at : member.stations) *out++ = at[which];
  return array;
}

Doubles station_places(const CombinationView& c) {
  const std::size_t stations = stations_of(c);
  const auto& members = c.building().members;
  Doubles array({members.size(), stations});
  double* out = array.mutable_data();
  for (const Member& member : members)
    for (std::size_t s = 0; s < stations; ++s)
      *out++ = member.length * static_cast<double>(s) / static_cast<double>(stations - 1);
  return array;
}

Doubles extremes(const CombinationView& c, bool largest) {
  return of_members(c, [largest](const MemberResult& m) { return &(largest ? m.max : m.min)[0].value; }, {8, 2},
                    {sizeof(Extreme), sizeof(double)});
}

py::dict largest_of(const CombinationView& c) {
  const LargestDisplacement& largest = c.get().largest;
  py::dict found;
  found["value"] = largest.value;
  found["displacement"] = vector_of(largest.moved);
  found["node"] = largest.node.valid() ? py::object(py::str(c.building()[largest.node].name)) : py::none();
  found["member"] = largest.member.valid() ? py::object(py::str(c.building()[largest.member].name)) : py::none();
  found["at"] = largest.at;
  found["mesh_node"] = largest.mesh_node >= 0 ? py::object(py::int_(largest.mesh_node)) : py::none();
  return found;
}

py::dict quality_of(const CombinationView& c) {
  const solver::SolveQuality& quality = c.get().quality;
  py::dict found;
  found["backward_error"] = quality.backward_error;
  found["condition"] = quality.condition;
  found["error_bound"] = quality.error_bound;
  found["refinements"] = quality.refinements;
  found["converged"] = quality.converged;
  found["equilibrium_error"] = c.get().equilibrium_error;
  found["discretisation_error"] = c.get().discretisation_error;
  found["second_order_iterations"] = c.get().second_order_iterations;
  return found;
}

py::dict cuts_of(const CombinationView& c) {
  const std::vector<SectionCut>& cuts = c.analysis->result->cuts;
  py::dict found;
  for (std::size_t k = 0; k < c.get().cuts.size(); ++k) {
    const CutResult& cut = c.get().cuts[k];
    py::dict parts;
    for (const auto& [id, force] : cut.members) parts[py::str(c.building()[id].name)] = vector_of(force);
    for (const auto& [id, force] : cut.panels) parts[py::str(c.building()[id].name)] = vector_of(force);
    for (const auto& [d, force] : cut.diaphragms) parts[py::str(c.building().diaphragms[d].name)] = vector_of(force);
    py::dict one;
    one["force"] = vector_of(cut.force);
    one["parts"] = std::move(parts);
    found[py::str(cuts[k].name)] = std::move(one);
  }
  return found;
}

void bind_nodes(Combination& combination) {
  combination
      .def_property_readonly(
          "displacements", [](const CombinationView& c) { return rows_of(c.get().displacements, c.owner()); },
          "Displacements of the nodes, shape (nodes, 6): x y z (m) rx ry rz (rad), global axes.")
      .def_property_readonly(
          "reactions", [](const CombinationView& c) { return rows_of(c.get().reactions, c.owner()); },
          "What the supports do to the structure, shape (supports, 6): N and N m, global axes; rows as "
          "Model.support_nodes.")
      .def_property_readonly(
          "edge_reactions", [](const CombinationView& c) { return rows_of(c.get().edge_reactions, c.owner()); },
          "What supported edges of panels do to them, shape (edge supports, 6): N, and N m about the edge's middle.")
      .def_property_readonly(
          "mesh_displacements", [](const CombinationView& c) { return rows_of(c.get().mesh_displacements, c.owner()); },
          "Displacements of the nodes of shells' meshes, shape (mesh nodes, 6): rows as Analysis.mesh_positions.")
      .def_property_readonly("largest_displacement", &largest_of,
                             "Where something moves most, a dict with value (m), displacement (3,), and the node, or "
                             "the member with the distance at "
                             "(m) from its first end, or the mesh_node.")
      .def_property_readonly(
          "total_load", [](const CombinationView& c) { return vector_of(c.get().total_load); },
          "Sum of the loads, shape (6,): N, and N m about the model's centroid, global axes.")
      .def_property_readonly(
          "total_reaction", [](const CombinationView& c) { return vector_of(c.get().total_reaction); },
          "Sum of the reactions, shape (6,): as total_load, with the opposite sign.")
      .def_property_readonly(
          "drifts",
          [](const CombinationView& c) {
            return field_of<StoreyResult, double>(
                c.get().storeys, [](const StoreyResult& s) { return &s.drift; }, c.owner());
          },
          "Storey drifts over storey heights, shape (storeys,), lowest first.")
      .def_property_readonly(
          "storey_shears",
          [](const CombinationView& c) {
            return field_of<StoreyResult, double>(c.get().storeys, [](const StoreyResult& s) { return s.shear.data(); },
                                                  c.owner(), {2}, {sizeof(double)});
          },
          "Horizontal forces through the storeys, shape (storeys, 2): along global x and y, N.")
      .def_property_readonly(
          "cuts", &cuts_of,
          "What passes the cuts that analyse() was given, a dict by name of dicts: force (6,), and parts, "
          "a dict of the same by member, panel or diaphragm. N, and N m about the cut's `at`, along its "
          "normal, along and across: what the part that the normal looks to does to the one behind.");
}

void bind_members(Combination& combination) {
  combination
      .def_property_readonly(
          "end_forces",
          [](const CombinationView& c) {
            return of_members(c, [](const MemberResult& m) { return m.end_forces.data(); }, {2, 6},
                              {6 * sizeof(double), sizeof(double)});
          },
          "What the nodes do to the members' ends, shape (members, 2, 6): x y z (N) rx ry rz (N m), local axes of the "
          "member; so tension is negative at the first end, positive at the second.")
      .def_property_readonly(
          "active",
          [](const CombinationView& c) {
            return field_of<MemberResult, bool>(
                c.get().members, [](const MemberResult& m) { return &m.active; }, c.owner());
          },
          "Shape (members,), bool: False for a member of one sign (tension or compression alone) that is slack.")
      .def(
          "diagram", &diagram, py::arg("quantity"),
          "Internal forces or deflections along the members, shape (members, stations + 1): even places from the first "
          "end to the second (station_places).\n\n"
          "quantity: one of topple.DIAGRAMS: axial (tension positive), shear_y, shear_z (N), torsion, moment_y, "
          "moment_z "
          "(N m), deflection_y, deflection_z (m, of the chord's own axes), in local axes. A new array.\n\n"
          "Raises ValueError for another name, and where analyse() was not asked for stations.")
      .def_property_readonly(
          "station_places", &station_places,
          "Places of the stations, shape (members, stations + 1): m from the first end. A new array.")
      .def_property_readonly(
          "minima", [](const CombinationView& c) { return extremes(c, false); },
          "Least values along the members, shape (members, 8, 2): for each of topple.DIAGRAMS the value and its place, "
          "m "
          "from the first end.")
      .def_property_readonly(
          "maxima", [](const CombinationView& c) { return extremes(c, true); },
          "Largest values along the members, shape (members, 8, 2): as minima.");
}

void bind_joints(Combination& combination) {
  combination
      .def_property_readonly(
          "utilisations",
          [](const CombinationView& c) {
            return use_field<double>(
                c.get().joints, [](const Utilisation& u) { return &u.value; }, c.owner());
          },
          "Demand over capacity of the joints, shape (joints,): 1 is the limit; 0 for a joint without capacity.")
      .def_property_readonly(
          "senses",
          [](const CombinationView& c) {
            static_assert(sizeof(Sense) == sizeof(std::int32_t));
            return use_field<std::int32_t>(
                c.get().joints, [](const Utilisation& u) { return reinterpret_cast<const std::int32_t*>(&u.sense); },
                c.owner());
          },
          "Index in topple.SENSES of the sense in which each joint is used most, shape (joints,).")
      .def_property_readonly(
          "demands",
          [](const CombinationView& c) {
            return use_field<double>(
                c.get().joints, [](const Utilisation& u) { return &u.demand; }, c.owner());
          },
          "What the joints bear in that sense, shape (joints,): N or N m (edges of panels: per m).")
      .def_property_readonly(
          "capacities",
          [](const CombinationView& c) {
            return use_field<double>(
                c.get().joints, [](const Utilisation& u) { return &u.capacity; }, c.owner());
          },
          "What they can bear in that sense, shape (joints,): units as demands.")
      .def_property_readonly(
          "design_utilisations",
          [](const CombinationView& c) {
            return field_of<DesignResult, double>(
                c.get().designs, [](const DesignResult& d) { return &d.utilisation; }, c.owner());
          },
          "Utilisation of the members by the design code, shape (members,), 0 where not checked; empty without "
          "analyse(..., code=...).")
      .def_property_readonly(
          "design_governing",
          [](const CombinationView& c) {
            std::vector<std::string> clauses;
            for (const DesignResult& design : c.get().designs) clauses.push_back(design.governing);
            return clauses;
          },
          "The clause that governs each member; \"\" where it is not checked.")
      .def_property_readonly(
          "design_refusals",
          [](const CombinationView& c) {
            py::dict refused;
            for (std::size_t m = 0; m < c.get().designs.size(); ++m)
              if (!c.get().designs[m].refusal.empty())
                refused[py::str(c.building().members[m].name)] = c.get().designs[m].refusal;
            return refused;
          },
          "Members that cannot be said to pass, with the reason.");
}

void bind_panels(Combination& combination) {
  const Shape doubles{sizeof(double)};
  combination
      .def_property_readonly(
          "panel_membrane",
          [doubles](const CombinationView& c) {
            return of_panels(
                c, [](const PanelResult& p) { return p.membrane.data(); }, {3}, doubles);
          },
          "Membrane forces of the panels, shape (panels, 3): n_x n_y n_xy, N/m, axes of the panel, tension positive.")
      .def_property_readonly(
          "panel_moments",
          [doubles](const CombinationView& c) {
            return of_panels(
                c, [](const PanelResult& p) { return p.moments.data(); }, {3}, doubles);
          },
          "Moments of shell panels, shape (panels, 3): m_x m_y m_xy, N m/m, axes of the panel.")
      .def_property_readonly(
          "panel_shears",
          [doubles](const CombinationView& c) {
            return of_panels(
                c, [](const PanelResult& p) { return p.shears.data(); }, {2}, doubles);
          },
          "Transverse shears of shell panels, shape (panels, 2): q_x q_y, N/m.")
      .def_property_readonly(
          "panel_corner_forces",
          [](const CombinationView& c) {
            return of_panels(c, [](const PanelResult& p) { return p.corner_forces[0].data(); }, {4, 6},
                             {sizeof(Vec6), sizeof(double)});
          },
          "What the nodes do to the panels' corners, shape (panels, 4, 6): N and N m, global axes.");
}

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

void bind_analysis(py::class_<Analysis, Shared>& analysis) {
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
          "Motion under the time history by the name of the combination.")
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
  Combination combination(
      module, "CombinationResult",
      "What one combination of loads does. Arrays are read-only views of the result, SI; they keep it "
      "alive.");
  combination.def_property_readonly(
      "model", [](const CombinationView& c) { return c.analysis->model; }, "The Model that was analysed.");
  combination.def_property_readonly(
      "name", [](const CombinationView& c) { return c.building()[c.get().combination].name; }, "Its name.");
  bind_nodes(combination);
  bind_members(combination);
  bind_joints(combination);
  bind_panels(combination);
  combination
      .def_property_readonly(
          "buckling",
          [](const CombinationView& c) { return parts_of<solver::BucklingMode>(c.analysis, c.get().buckling); },
          "Buckling modes (list of BucklingMode), lowest factor first.")
      .def_property_readonly(
          "quality", &quality_of,
          "How far to trust the answer, a dict with componentwise backward_error, condition, error_bound on the "
          "displacements, "
          "refinements, converged, equilibrium_error, discretisation_error of shells, second_order_iterations.")
      .def("__repr__", [](const CombinationView& c) {
        return "<topple.CombinationResult \"" + c.building()[c.get().combination].name + "\">";
      });
  py::class_<Analysis, Shared> analysis(module, "Analysis", "What analyse() found.");
  bind_analysis(analysis);
}

}  // namespace topple::python
