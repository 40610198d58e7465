// Model: a building from a file or a dict, its names and its geometry as arrays.
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>

#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "model.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/parse_cuts.h"
#include "topple/structure/modelling_checks.h"

namespace topple::python {

using namespace structure;

std::string utf8_of(const py::handle& text) {
  Py_ssize_t length = 0;
  const char* const bytes = PyUnicode_AsUTF8AndSize(text.ptr(), &length);
  if (bytes == nullptr) throw py::error_already_set();
  return {bytes, static_cast<std::size_t>(length)};
}

namespace {

/// Throws for the first number that is not finite, with its place among dicts and lists; for none where they go deeper
/// than any format, or round in a circle.
void refuse_not_finite(const py::handle& value, const std::string& path, int depth = 0) {
  constexpr int deepest = 200;
  if (depth > deepest) return;
  if (py::isinstance<py::float_>(value)) {
    const auto number = value.cast<double>();
    if (std::isfinite(number)) return;
    const std::string found = std::isnan(number) ? "nan" : "inf";
    throw PlacedInputError({"dict", path}, "found " + found + "; accepted: a number that is finite");
  }
  if (py::hasattr(value, "tolist")) return refuse_not_finite(value.attr("tolist")(), path, depth + 1);
  if (py::isinstance<py::dict>(value)) {
    for (const auto& [key, item] : py::reinterpret_borrow<py::dict>(value))
      refuse_not_finite(item, path + (path.empty() ? "" : ".") + utf8_of(py::str(key)), depth + 1);
  } else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    std::size_t place = 0;
    for (const py::handle item : value) refuse_not_finite(item, path + "[" + std::to_string(place++) + "]", depth + 1);
  }
}

}  // namespace

std::string json_text(const py::handle& value) {
  // numpy's numbers and arrays know how to become Python's own.
  const py::cpp_function plain([](const py::object& other) -> py::object {
    if (py::hasattr(other, "tolist")) return other.attr("tolist")();
    if (py::hasattr(other, "__fspath__")) return py::str(other);
    throw py::type_error("found " + std::string(py::str(other.get_type().attr("__name__"))) +
                         "; accepted: what JSON can hold, numpy numbers and arrays, paths");
  });
  try {
    return utf8_of(py::module_::import("json").attr("dumps")(
        value, py::arg("default") = plain, py::arg("ensure_ascii") = false, py::arg("allow_nan") = false));
  } catch (py::error_already_set& error) {
    if (error.matches(PyExc_ValueError) && !error.matches(PyExc_UnicodeError)) refuse_not_finite(value, {});
    throw;
  }
}

py::object json_object(const std::string& text) { return py::module_::import("json").attr("loads")(text); }

std::optional<std::string> path_of(const py::handle& value) {
  if (py::isinstance<py::str>(value)) return utf8_of(value);
  if (py::hasattr(value, "__fspath__")) return utf8_of(py::str(value.attr("__fspath__")()));
  return std::nullopt;
}

namespace {

/// What the command line warns of as well.
Building with_warnings(Building building) {
  for (std::string& warning : modelling_warnings(building)) building.warnings.push_back(std::move(warning));
  return building;
}

std::shared_ptr<Model> read(const py::object& source) {
  if (const auto path = path_of(source)) {
    const py::gil_scoped_release others_run;
    const std::filesystem::path file = find_model(*path);
    Building building = with_warnings(read_model(file));
    std::vector<SectionCut> cuts = read_model_cuts(file, building);
    return std::make_shared<Model>(std::move(building), std::move(cuts));
  }
  if (!py::isinstance<py::dict>(source))
    throw py::type_error("Model: found " + std::string(py::str(source.get_type().attr("__name__"))) +
                         "; accepted: a shipped model's name, a path, or a dict in the model format");
  const std::string text = json_text(source);
  const py::gil_scoped_release others_run;
  return read_from_objects("model", [&] {
    Building building = with_warnings(parse_model(text, "model"));
    std::vector<SectionCut> cuts = parse_model_cuts(text, "model", building);
    return std::make_shared<Model>(std::move(building), std::move(cuts));
  });
}

/// The index of what a name names; raises KeyError with what may have been meant.
template <class Id>
int index_of(const std::optional<Id>& found, const char* kind, const std::string& name,
             const std::vector<std::string>& known) {
  if (!found) throw py::key_error("there is no " + std::string(kind) + " \"" + name + "\"" + did_you_mean(name, known));
  return found->index;
}

const char* kind_name(MemberKind kind) {
  return kind == MemberKind::post ? "post" : kind == MemberKind::beam ? "beam" : "brace";
}

py::dict units_of(const Units& units) {
  py::dict result;
  result["length"] = py::make_tuple(units.length_name, units.length);
  result["force"] = py::make_tuple(units.force_name, units.force);
  result["mass"] = py::make_tuple(units.mass_name, units.mass);
  return result;
}

void bind_names(py::class_<Model, std::shared_ptr<Model>>& model) {
  const auto list = [&](const char* name, auto items, const char* doc) {
    model.def_property_readonly(
        name, [items](const Model& m) { return names_of(m.building().*items); }, doc);
  };
  list("node_names", &Building::nodes, "Names of the nodes, rows of positions and displacements.");
  list("member_names", &Building::members, "Names of the members, rows of end_forces and diagrams.");
  list("panel_names", &Building::panels, "Names of the panels, rows of panel_membrane and kin.");
  list(
      "joint_names", &Building::joints,
      "Names of the joints (\"C1:1\" is the first end of member C1, \"S1:3\" the third edge of panel S1): two for each "
      "member, then four for each panel.");
  list("case_names", &Building::cases, "Names of the load cases.");
  list("combination_names", &Building::combinations, "Names of the load combinations.");
  list("material_names", &Building::materials, "Names of the materials.");
  list("section_names", &Building::sections, "Names of the sections.");
}

void bind_look_ups(py::class_<Model, std::shared_ptr<Model>>& model) {
  model
      .def(
          "node",
          [](const Model& m, const std::string& name) {
            return index_of(m.names().node(name), "node", name, names_of(m.building().nodes));
          },
          py::arg("name"), "Index of a node by its name. Raises KeyError.")
      .def(
          "member",
          [](const Model& m, const std::string& name) {
            return index_of(m.names().member(name), "member", name, names_of(m.building().members));
          },
          py::arg("name"), "Index of a member by its name. Raises KeyError.")
      .def(
          "panel",
          [](const Model& m, const std::string& name) {
            return index_of(m.names().panel(name), "panel", name, names_of(m.building().panels));
          },
          py::arg("name"), "Index of a panel by its name. Raises KeyError.")
      .def(
          "joint",
          [](const Model& m, const std::string& name) {
            return index_of(m.names().joint(name), "joint", name, names_of(m.building().joints));
          },
          py::arg("name"), "Index of a joint by its name. Raises KeyError.")
      .def(
          "nodes_matching",
          [](const Model& m, const std::string& p) { return indices_of(m.names().nodes_matching(p)); },
          py::arg("pattern"), "Indices of nodes whose names match a pattern, in which * stands for any characters.")
      .def(
          "members_matching",
          [](const Model& m, const std::string& p) { return indices_of(m.names().members_matching(p)); },
          py::arg("pattern"), "Indices of members whose names match a pattern.")
      .def(
          "panels_matching",
          [](const Model& m, const std::string& p) { return indices_of(m.names().panels_matching(p)); },
          py::arg("pattern"), "Indices of panels whose names match a pattern.")
      .def(
          "joints_matching",
          [](const Model& m, const std::string& p) { return indices_of(m.names().joints_matching(p)); },
          py::arg("pattern"), "Indices of joints whose names match a pattern.")
      .def(
          "group",
          [](const Model& m, const std::string& name) {
            const NameIndex::Group* group = m.names().group(name);
            if (group == nullptr)
              throw py::key_error("there is no group \"" + name +
                                  "\"; accepted: posts, beams, braces, slabs, walls and the groups of the model");
            return py::make_tuple(indices_of(group->members), indices_of(group->panels));
          },
          py::arg("name"),
          "Members and panels of a group, as two arrays of indices: posts, beams, braces, slabs, walls, or one of the "
          "model's own. Raises KeyError.");
}

void bind_members(py::class_<Model, std::shared_ptr<Model>>& model) {
  model
      .def_property_readonly(
          "positions",
          [](const Model& m) {
            return field_of<Node, double>(m.building().nodes, [](const Node& n) { return n.position.data(); },
                                          m.shared(), {3}, {sizeof(double)});
          },
          "Positions of the nodes, shape (nodes, 3), m, global axes (z up).")
      .def_property_readonly(
          "member_nodes",
          [](const Model& m) {
            return field_of<Member, std::int32_t>(m.building().members,
                                                  [](const Member& one) { return &one.nodes[0].index; }, m.shared(),
                                                  {2}, {sizeof(NodeId)});
          },
          "Indices of the nodes at the members' ends, shape (members, 2).")
      .def_property_readonly(
          "member_axes",
          [](const Model& m) {
            return field_of<Member, double>(m.building().members, [](const Member& one) { return one.axes.data(); },
                                            m.shared(), {3, 3}, {sizeof(double), 3 * sizeof(double)});
          },
          "Local axes of the members, shape (members, 3, 3): rows are local x (first end to second), y, z in global "
          "axes.")
      .def_property_readonly(
          "member_offsets",
          [](const Model& m) {
            return field_of<Member, double>(m.building().members,
                                            [](const Member& one) { return one.offsets[0].data(); }, m.shared(), {2, 3},
                                            {sizeof(Vec3), sizeof(double)});
          },
          "Rigid arms from the nodes to the members' ends, shape (members, 2, 3), m, global axes.")
      .def_property_readonly(
          "member_lengths",
          [](const Model& m) {
            return field_of<Member, double>(
                m.building().members, [](const Member& one) { return &one.length; }, m.shared());
          },
          "Lengths of the members between their ends, shape (members,), m.")
      .def_property_readonly(
          "member_kinds",
          [](const Model& m) {
            std::vector<std::string> kinds;
            for (const Member& member : m.building().members) kinds.emplace_back(kind_name(member.kind));
            return kinds;
          },
          "\"post\", \"beam\" or \"brace\" for each member.")
      .def_property_readonly(
          "member_sections",
          [](const Model& m) {
            return field_of<Member, std::int32_t>(
                m.building().members, [](const Member& one) { return &one.section.index; }, m.shared());
          },
          "Indices of the members' sections in section_names, shape (members,).");
}

void bind_other_parts(py::class_<Model, std::shared_ptr<Model>>& model) {
  model
      .def_property_readonly(
          "panel_nodes",
          [](const Model& m) {
            return field_of<Panel, std::int32_t>(m.building().panels,
                                                 [](const Panel& one) { return &one.nodes[0].index; }, m.shared(), {4},
                                                 {sizeof(NodeId)});
          },
          "Indices of the nodes at the panels' corners, shape (panels, 4).")
      .def_property_readonly(
          "support_nodes",
          [](const Model& m) {
            return field_of<NodeSupport, std::int32_t>(
                m.building().supports, [](const NodeSupport& one) { return &one.node.index; }, m.shared());
          },
          "Indices of the supported nodes, shape (supports,): rows of reactions.")
      .def_property_readonly(
          "capacities",
          [](const Model& m) {
            return field_of<Joint, double>(m.building().joints,
                                           [](const Joint& one) { return one.capacity.value.data(); }, m.shared(), {7},
                                           {sizeof(double)});
          },
          "Capacities of the joints in the order of topple.SENSES, shape (joints, 7), N and N m (edges of panels: per "
          "m); "
          "inf where there is none.");
}

}  // namespace

std::shared_ptr<Model> model_of(const py::object& source) {
  if (py::isinstance<Model>(source)) return source.cast<std::shared_ptr<Model>>();
  return read(source);
}

void bind_model(py::module_& module) {
  py::class_<Model, std::shared_ptr<Model>> model(module, "Model",
                                                  "A building: nodes, members, panels, joints, loads.\n\n"
                                                  "Numbers are SI whatever the file's units are (unless it says "
                                                  "\"consistent\": then they are the file's own). Arrays "
                                                  "are read-only views of the library's memory.");
  model
      .def(py::init(&read), py::arg("source"),
           "Reads a model: a shipped one's name (\"la3\"), a path to a file (.json, .3dd) or to a folder of tables, or "
           "a dict with the keys of the model format (docs/model-format.md), numpy numbers and arrays included.\n\n"
           "Raises InputError with the place; TypeError for anything else.")
      .def_property_readonly(
          "title", [](const Model& m) { return m.building().title; }, "The model's title.")
      .def_property_readonly(
          "file", [](const Model& m) { return m.building().file; }, "What it was read from, as messages call it.")
      .def_property_readonly(
          "units", [](const Model& m) { return units_of(m.building().units); },
          "The file's units: name and factor to SI of length, force and mass.")
      .def_property_readonly(
          "gravity", [](const Model& m) { return m.building().gravity; }, "Acceleration of gravity, m/s2.")
      .def_property_readonly(
          "warnings", [](const Model& m) { return m.building().warnings; },
          "What was found odd in the model, a sentence each.")
      .def(
          "plot",
          [](const py::object& self, const py::args& args, const py::kwargs& options) {
            return py::module_::import("topple.plot").attr("shape")(self, *args, **options);
          },
          "Draws the model: topple.plot.shape(model, ...).")
      .def("__repr__", [](const Model& m) {
        const Building& b = m.building();
        return "<topple.Model \"" + b.title + "\": " + std::to_string(b.nodes.size()) + " nodes, " +
               std::to_string(b.members.size()) + " members, " + std::to_string(b.panels.size()) + " panels>";
      });
  bind_names(model);
  bind_look_ups(model);
  bind_members(model);
  bind_other_parts(model);
}

}  // namespace topple::python
