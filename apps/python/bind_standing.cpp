// What stands and what moves, in parts, and what is written of a run.
#include "arrays.h"
#include "simulation_bindings.h"
#include "topple/structure/modelling_checks.h"

namespace topple::python {

using namespace structure;

namespace {

/// A moving body as it was when it was asked for.
struct Body {
  std::shared_ptr<const Scene> scene;
  BodyView view;
  std::string name;
  std::vector<MemberId> members;
  std::vector<PanelId> panels;
};

const char* piece_name(PieceKind kind) {
  constexpr std::array<const char*, 5> names{"slab", "wall", "post", "beam", "brace"};
  return names[static_cast<std::size_t>(kind)];
}

/// A new array with `numbers` for each of `count` things.
template <class Get>
Doubles numbers_of(std::size_t count, std::size_t numbers, Get get) {
  Doubles array({count, numbers});
  double* out = array.mutable_data();
  for (std::size_t i = 0; i < count; ++i) {
    const auto& values = get(i);
    out = std::copy(values.data(), values.data() + numbers, out);
  }
  return array;
}

template <class T, class Get>
py::array_t<T> each(std::size_t count, Get get) {
  py::array_t<T> array(static_cast<py::ssize_t>(count));
  for (std::size_t i = 0; i < count; ++i) array.mutable_data()[i] = get(i);
  return array;
}

/// The member or panel of a name.
std::variant<MemberId, PanelId> part_of(const Model& model, const std::string& name) {
  if (const auto member = model.names().member(name)) return *member;
  if (const auto panel = model.names().panel(name)) return *panel;
  throw py::key_error("there is no member or panel \"" + name + "\"" +
                      did_you_mean(name, names_of(model.building().members)));
}

py::list what_carries(SimulationHost& host, const std::string& name) {
  const auto part = part_of(*host.scene().model, name);
  const auto carriers =
      host.compute([&](Simulation& s) { return std::visit([&](auto id) { return s.what_carries(id); }, part); });
  py::list found;
  for (const Carrier& carrier : carriers)
    found.append(py::make_tuple(host.building()[carrier.joint].name, carrier.share));
  return found;
}

py::list next_to_break(SimulationHost& host, std::size_t count) {
  const auto nearest = host.compute([&](Simulation& s) { return s.next_to_break(count); });
  py::list found;
  for (const auto& [joint, use] : nearest)
    found.append(
        py::make_tuple(host.building()[joint].name, use.value, sense_names[static_cast<std::size_t>(use.sense)]));
  return found;
}

py::object ray_cast(SimulationHost& host, const std::array<double, 3>& from, const std::array<double, 3>& direction) {
  const auto hit = host.compute([&](Simulation& s) {
    return s.ray_cast(Vec3(from[0], from[1], from[2]), Vec3(direction[0], direction[1], direction[2]));
  });
  if (!hit) return py::none();
  const Building& building = host.building();
  py::dict found;
  found["member"] = hit->member.valid() ? py::object(py::str(building[hit->member].name)) : py::none();
  found["panel"] = hit->panel.valid() ? py::object(py::str(building[hit->panel].name)) : py::none();
  found["body"] = hit->body.value >= 0 ? py::object(py::int_(hit->body.value)) : py::none();
  found["point"] = vector_of(hit->point);
  found["distance"] = hit->distance;
  return found;
}

py::object chunk_of(const Body& body) {
  const auto& mesh = body.view.chunk;
  if (!mesh) return py::none();
  using Triangle = std::array<int, 3>;
  return py::make_tuple(rows_of(mesh->positions, mesh),
                        field_of<Triangle, std::int32_t>(
                            mesh->triangles, [](const Triangle& one) { return one.data(); }, mesh, {3}, {sizeof(int)}));
}

}  // namespace

py::list bodies_of(SimulationHost& host) {
  return host.with([&](Simulation& s) {
    py::list bodies;
    for (const BodyView& view : s.bodies())
      bodies.append(Body{host.shared_scene(),
                         view,
                         std::string(view.name),
                         {view.members.begin(), view.members.end()},
                         {view.panels.begin(), view.panels.end()}});
    return bodies;
  });
}

void bind_body(py::module_& module) {
  py::class_<Body>(module, "Body", "A moving body as it was when it was asked for: debris of the building, or a ball.")
      .def_property_readonly(
          "handle", [](const Body& b) { return b.view.id.value; }, "Its handle, never used again.")
      .def_property_readonly(
          "name", [](const Body& b) { return b.name; }, "Name of its first member, else panel, chunk or ball.")
      .def_property_readonly(
          "position", [](const Body& b) { return vector_of(b.view.pose.position); },
          "Of its centre of mass, shape (3,), m.")
      .def_property_readonly(
          "orientation", [](const Body& b) { return vector_of(Eigen::Vector4d(b.view.pose.orientation.coeffs())); },
          "As a quaternion x y z w, shape (4,), from the undeformed building.")
      .def_property_readonly(
          "rest_centre", [](const Body& b) { return vector_of(b.view.rest_centre); },
          "Where its centre of mass was in the undeformed building, shape (3,), m. A point p of a "
          "member moves to position + rotation (p - rest_centre).")
      .def_property_readonly(
          "mass", [](const Body& b) { return b.view.mass; }, "kg.")
      .def_property_readonly(
          "radius", [](const Body& b) { return b.view.radius; }, "Above 0 for a ball, m.")
      .def_property_readonly(
          "asleep", [](const Body& b) { return b.view.asleep; }, "True while it lies still.")
      .def_property_readonly(
          "members", [](const Body& b) { return names_of(b.scene->model->building(), b.members); },
          "Names of its members.")
      .def_property_readonly(
          "panels", [](const Body& b) { return names_of(b.scene->model->building(), b.panels); },
          "Names of its panels.")
      .def_property_readonly(
          "chunk", &chunk_of,
          "Of a piece of a panel, or of a member that was cut in two, its mesh as vertices (n, 3), m "
          "about its centre of mass, and triangles (m, 3); else None.")
      .def_property_readonly(
          "chunk_of",
          [](const Body& b) -> py::object {
            return b.view.chunk ? py::object(py::str(piece_name(b.view.chunk_of))) : py::none();
          },
          "What a chunk is a piece of, \"slab\", \"wall\", \"post\", \"beam\" or \"brace\"; else None.")
      .def("__repr__", [](const Body& b) { return "<topple.Body \"" + b.name + "\">"; });
}

namespace {

/// What stands, in numbers.
void bind_answers(BoundSimulation& simulation) {
  simulation
      .def_property_readonly(
          "displacements",
          [](SimulationHost& h) {
            return h.with([](Simulation& s) {
              return numbers_of(
                  s.building().nodes.size(),
                  6, [&](std::size_t i) -> auto& { return s.frame().displacement(NodeId(i)); });
            });
          },
          "Displacements of the nodes in the last state of rest, shape (nodes, 6), m and rad, global axes; of a node "
          "that "
          "left, as it was then. A new array.")
      .def_property_readonly(
          "utilisations",
          [](SimulationHost& h) {
            return h.with([](Simulation& s) {
              return each<double>(s.building().joints.size(),
                                  [&](std::size_t i) { return s.frame().utilisation(JointId(i)).value; });
            });
          },
          "Demand over capacity of the joints, shape (joints,); 0 where a joint has no capacity or holds no more. A "
          "new "
          "array.")
      .def_property_readonly(
          "demands",
          [](SimulationHost& h) {
            return h.with([](Simulation& s) {
              return numbers_of(s.building().joints.size(), 6,
                                [&](std::size_t i) { return s.frame().demand(JointId(i)); });
            });
          },
          "What the joints bear, shape (joints, 6), N and N m (edges of panels per m), their own axes, tension "
          "positive in "
          "x. A new array.")
      .def_property_readonly(
          "end_forces",
          [](SimulationHost& h) {
            return h.with([](Simulation& s) -> Doubles {
              return numbers_of(s.building().members.size(), 12,
                                [&](std::size_t i) { return s.frame().end_forces(MemberId(i)); })
                  .reshape({static_cast<py::ssize_t>(s.building().members.size()), py::ssize_t{2}, py::ssize_t{6}});
            });
          },
          "What the nodes do to the members' ends, shape (members, 2, 6), as CombinationResult.end_forces; 0 for what "
          "does "
          "not stand. A new array.")
      .def_property_readonly(
          "reactions",
          [](SimulationHost& h) {
            return h.with([](Simulation& s) {
              return numbers_of(s.building().supports.size(), 6, [&](std::size_t i) { return s.frame().reaction(i); });
            });
          },
          "What the supports do to the structure, shape (supports, 6), N and N m, global axes. A new array.");
}

/// Which joints hold, and what each part is in by now.
void bind_whereabouts(BoundSimulation& simulation) {
  simulation
      .def_property_readonly(
          "joints_hold",
          [](SimulationHost& h) {
            return h.with([](Simulation& s) {
              return each<bool>(s.building().joints.size(),
                                [&](std::size_t i) { return s.frame().intact(JointId(i)); });
            });
          },
          "Shape (joints,), bool, False for a joint that broke. A new array.")
      .def_property_readonly(
          "member_bodies",
          [](SimulationHost& h) {
            return h.with([](Simulation& s) {
              return each<std::int64_t>(s.building().members.size(),
                                        [&](std::size_t i) { return s.body_of(MemberId(i)).value; });
            });
          },
          "Handle of the body that each member is part of, shape (members,); -1 where it stands, -2 where it is gone. "
          "A "
          "new array.")
      .def_property_readonly(
          "panel_bodies",
          [](SimulationHost& h) {
            return h.with([](Simulation& s) {
              return each<std::int64_t>(s.building().panels.size(),
                                        [&](std::size_t i) { return s.body_of(PanelId(i)).value; });
            });
          },
          "The same of the panels, shape (panels,). A new array.")
      .def_property_readonly(
          "segments",
          [](SimulationHost& h) {
            return h.with([](Simulation& s) {
              return each<std::int32_t>(s.building().members.size(),
                                        [&](std::size_t i) { return s.frame().segment(MemberId(i)); });
            });
          },
          "Number of the standing segment that each member is part of, shape (members,); -1 where it does not stand. A "
          "new "
          "array.");
}

void bind_questions(BoundSimulation& simulation) {
  simulation
      .def(
          "what_carries", &what_carries, py::arg("part"),
          "What carries a member or panel? List of (joint, share), the joints through which at least 1 % of a vertical "
          "force in its middle goes, the largest share first; empty for what does not stand. Raises KeyError.")
      .def("next_to_break", &next_to_break, py::arg("count") = 10,
           "List of (joint, utilisation, sense), the joints nearest to their capacity, the nearest first.")
      .def("ray_cast", &ray_cast, py::arg("origin"), py::arg("direction"),
           "The nearest thing along a ray, a dict with member, panel or body, point (3,) and distance (m); None for "
           "nothing.");
}

}  // namespace

void bind_standing(BoundSimulation& simulation) {
  bind_answers(simulation);
  bind_whereabouts(simulation);
  bind_questions(simulation);
}

py::object summary_of(SimulationHost& host) {
  return json_object(host.compute([&](Simulation& s) { return summary_json(s, host.times(), host.roof_sag()); }));
}
py::object standing_of(SimulationHost& host) {
  return json_object(host.compute([&](Simulation& s) { return standing_json(s); }));
}
std::string text_of(SimulationHost& host) {
  return host.compute([&](Simulation& s) { return collapse_text(s, host.times()); });
}
void write_to(SimulationHost& host, const std::filesystem::path& folder) {
  host.compute([&](Simulation& s) { write_collapse(folder, s, host.times(), host.roof_sag()); });
}

}  // namespace topple::python
