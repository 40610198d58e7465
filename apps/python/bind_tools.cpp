// What is done to a running simulation: tools, and bodies of the host.
#include "arrays.h"
#include "errors.h"
#include "simulation_bindings.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/scenario_text.h"

namespace topple::python {

using namespace structure;
using namespace py::literals;

namespace {

void apply(SimulationHost& host, const py::dict& tool) {
  const std::string text = json_text(tool);
  host.with([&](Simulation& s) {
    s.apply(read_from_objects("tool", [&] { return parse_tool(text, "tool", s.building()); }));
  });
}

/// One name is a list of one.
py::object list_of(const py::object& names) {
  if (names.is_none()) return py::list();
  if (!py::isinstance<py::str>(names)) return py::list(names);
  py::list one;
  one.append(names);
  return one;
}

/// Only what was given, so that the reader's defaults hold for the rest.
py::dict given(std::initializer_list<std::pair<const char*, py::object>> items) {
  py::dict all;
  for (const auto& [key, value] : items)
    if (!value.is_none()) all[key] = value;
  return all;
}

void bind_throwing(BoundSimulation& simulation) {
  simulation
      .def(
          "fire",
          [](SimulationHost& h, const py::object& origin, const py::object& velocity, const py::object& mass,
             const py::object& radius) {
            apply(h, py::dict("projectile"_a = given(
                                  {{"from", origin}, {"velocity", velocity}, {"mass", mass}, {"radius", radius}})));
          },
          py::arg("origin"), py::arg("velocity"), py::arg("mass") = py::none(), py::arg("radius") = py::none(),
          "Fires a ball in the next step, from origin (3,), m, with velocity (3,), m/s; mass 500 kg and radius 0.4 m "
          "unless "
          "given. Raises InputError.")
      .def(
          "swing",
          [](SimulationHost& h, const py::object& anchor, const py::object& origin, const py::object& cable,
             const py::object& mass, const py::object& radius) {
            apply(
                h,
                py::dict(
                    "wrecking_ball"_a = given(
                        {{"anchor", anchor}, {"from", origin}, {"cable", cable}, {"mass", mass}, {"radius", radius}})));
          },
          py::arg("anchor"), py::arg("origin"), py::arg("cable"), py::arg("mass") = py::none(),
          py::arg("radius") = py::none(),
          "Lets go of a wrecking ball at origin (3,) that hangs from anchor (3,) by a cable, all m; mass 3000 kg and "
          "radius "
          "0.8 m unless given. Raises InputError.")
      .def(
          "charge",
          [](SimulationHost& h, const py::object& centre, double radius, const std::array<double, 2>& strength) {
            apply(h,
                  py::dict("charge"_a = py::dict("centre"_a = centre, "radius"_a = radius, "strength"_a = strength)));
          },
          py::arg("centre"), py::arg("radius"), py::arg("strength") = std::array<double, 2>{0, 1},
          "Multiplies the strength of joints within radius (m) of centre (3,) by a factor that goes from strength[0] "
          "there "
          "to strength[1] at the radius; 0 breaks them. Raises InputError.");
}

void bind_weakening(BoundSimulation& simulation) {
  simulation
      .def(
          "cut",
          [](SimulationHost& h, const py::object& joints) {
            apply(h, py::dict("cut"_a = py::dict("joints"_a = list_of(joints))));
          },
          py::arg("joints"), "Breaks joints (names, patterns). Raises InputError.")
      .def(
          "remove",
          [](SimulationHost& h, const py::object& members, const py::object& panels, const py::object& supports,
             const py::object& groups) {
            apply(h, py::dict("remove"_a = py::dict("members"_a = list_of(members), "panels"_a = list_of(panels),
                                                    "supports"_a = list_of(supports), "groups"_a = list_of(groups))));
          },
          py::arg("members") = py::none(), py::arg("panels") = py::none(), py::arg("supports") = py::none(),
          py::arg("groups") = py::none(),
          "Takes members, panels, supports (names of nodes) and groups away (names, patterns). Raises InputError.")
      .def(
          "weaken",
          [](SimulationHost& h, const py::object& members, const py::object& joints, const py::object& groups,
             const py::object& strength, const py::object& stiffness, double over, int stages) {
            const py::dict tool = given({{"strength", strength}, {"stiffness", stiffness}});
            tool["members"] = list_of(members);
            tool["joints"] = list_of(joints);
            tool["groups"] = list_of(groups);
            tool["over"] = over;
            tool["stages"] = stages;
            apply(h, py::dict("weaken"_a = tool));
          },
          py::arg("members") = py::none(), py::arg("joints") = py::none(), py::arg("groups") = py::none(),
          py::arg("strength") = py::none(), py::arg("stiffness") = py::none(), py::arg("over") = 0.0,
          py::arg("stages") = 1,
          "Multiplies the strength of joints and the stiffness of members by a factor, in equal stages through `over` "
          "seconds, as a fire does. Raises InputError.")
      .def(
          "set_gravity",
          [](SimulationHost& h, const py::object& gravity) { apply(h, py::dict("gravity"_a = gravity)); },
          py::arg("gravity"), "Sets gravity, shape (3,), m/s2. Raises InputError.")
      .def(
          "load",
          [](SimulationHost& h, const py::dict& nodes) { apply(h, py::dict("load"_a = py::dict("nodes"_a = nodes))); },
          py::arg("nodes"),
          "Adds loads to nodes, {name: {\"x\": N, ..., \"rz\": N m}}, global axes. Raises InputError.");
}

/// The body of a host that touches a part.
void touch(SimulationHost& host, std::int64_t key, const std::string& part, std::int64_t body,
           const std::array<double, 3>& point, const std::array<double, 3>& normal, double mass,
           const std::array<std::array<double, 3>, 3>& inertia, const std::array<double, 3>& centre,
           const std::array<double, 3>& velocity, const std::array<double, 3>& angular_velocity) {
  const auto vector = [](const std::array<double, 3>& v) { return Vec3(v[0], v[1], v[2]); };
  HostContact contact;
  contact.key = key;
  const NameIndex& names = host.scene().model->names();
  if (!part.empty()) {
    if (const auto member = names.member(part)) contact.member = *member;
    if (const auto panel = names.panel(part)) contact.panel = *panel;
    if (!contact.member.valid() && !contact.panel.valid())
      throw py::key_error("there is no member or panel \"" + part + "\"");
  }
  contact.body = {body};
  contact.point = vector(point);
  contact.normal = vector(normal);
  contact.mass = mass;
  for (int row = 0; row < 3; ++row)
    contact.inertia.row(row) = vector(inertia[static_cast<std::size_t>(row)]).transpose();
  contact.centre = vector(centre);
  contact.velocity = vector(velocity);
  contact.angular_velocity = vector(angular_velocity);
  host.with([&](Simulation& s) { s.touch(contact); });
}

py::list host_impulses(SimulationHost& host) {
  return host.with([](Simulation& s) {
    py::list all;
    for (const HostImpulse& one : s.host_impulses())
      all.append(py::dict("key"_a = one.key, "impulse"_a = vector_of(one.impulse), "speed_in"_a = one.speed_in,
                          "speed_out"_a = one.speed_out, "through"_a = one.through));
    return all;
  });
}

}  // namespace

void bind_tools(BoundSimulation& simulation) {
  simulation.def(
      "apply", &apply, py::arg("tool"),
      "Uses a tool in the next step, a dict as an event of a scenario has it (docs/scenario-format.md), such as "
      "{\"projectile\": {\"from\": [-20, 0, 2], \"velocity\": [60, 0, 0]}}. Raises InputError with the place.");
  bind_throwing(simulation);
  bind_weakening(simulation);
  simulation
      .def("touch", &touch, py::arg("key"), py::kw_only(), py::arg("part") = "", py::arg("body") = -1, py::arg("point"),
           py::arg("normal"), py::arg("mass"), py::arg("inertia"), py::arg("centre"), py::arg("velocity"),
           py::arg("angular_velocity") = std::array<double, 3>{},
           "A body of the host (a car, say) comes to touch a standing part (by name) or a body (by handle); it strikes "
           "in "
           "the next step by the law of impact.\n\n"
           "key: given back with the impulse. point (3,), m; normal (3,), unit, into what is touched; mass kg; inertia "
           "(3, 3), kg m2, about centre (3,), m; velocity (3,), m/s; angular_velocity (3,), rad/s; global axes. Raises "
           "InputError, KeyError.")
      .def_property_readonly(
          "host_impulses", &host_impulses,
          "What those of the last step felt, in the order of touch(), dicts with key, impulse (3,) on "
          "the host's body (N s), speed_in and speed_out along the normal (m/s), through (True when "
          "what stood in its way stands no more).");
}

}  // namespace topple::python
