// CombinationResult: everything that one combination of loads does, as arrays.
#include "bindings.h"
#include "results.h"
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

}  // namespace

void bind_combination(py::module_& module) {
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
}

}  // namespace topple::python
