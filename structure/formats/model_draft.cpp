#include "formats/model_draft.h"

#include <cmath>

#include "formats/geometry.h"
#include "model/index_of.h"
#include "sections/section_capacity.h"

namespace topple::structure::formats {

namespace {

template <class Part>
std::string names_of(const std::vector<Part>& parts) {
  std::vector<std::string_view> names;
  for (const Part& part : parts) names.push_back(part.name);
  return quoted_list(names);
}

template <class Id, class Part>
Id look_up(const Names<Id>& names, const std::vector<Part>& parts, std::string_view name, const char* kind,
           const JsonValue& place) {
  if (const auto id = names.find(name)) return *id;
  place.fail(std::string("there is no ") + kind + " " + in_quotes(name) + "; accepted: " + names_of(parts));
}

template <class Id, class Part>
Id add_named(Names<Id>& names, std::vector<Part>& parts, Part part, const char* kind, const JsonValue& place) {
  const Id id(parts.size());
  if (!names.add(part.name, id))
    place.fail(std::string("a ") + kind + " named " + in_quotes(part.name) +
               " is there already; accepted: each name once");
  parts.push_back(std::move(part));
  return id;
}

bool is_group_of_a_kind(const std::string& group) {
  return group == "posts" || group == "beams" || group == "braces" || group == "slabs" || group == "walls";
}

void check_groups(const std::vector<std::string>& groups, const JsonValue& place) {
  for (const std::string& group : groups)
    if (group.empty() || is_group_of_a_kind(group))
      place.fail("the group " + in_quotes(group) + "; accepted: names other than those that follow from `kind`");
}

}  // namespace

double scaled(const JsonValue& value, double factor) {
  const double product = value.number() * factor;
  if (!std::isfinite(product)) value.refuse("a number that is finite in SI units");
  return product;
}

void ModelDraft::check_name(const std::string& name, const JsonValue& place) const {
  if (name.empty() || name.find('*') != std::string::npos)
    place.fail("the name " + in_quotes(name) + "; accepted: a name that is not empty and holds no *");
}

void ModelDraft::check_part_name(const std::string& name, const JsonValue& place) const {
  check_name(name, place);
  if (members_.find(name) || panels_.find(name))
    place.fail("a member or panel named " + in_quotes(name) + " is there already; accepted: each name once");
}

NodeId ModelDraft::add_node(const std::string& name, const Vec3& position, const JsonValue& place) {
  check_name(name, place);
  support_of_node_.push_back(-1);
  return add_named(nodes_, building.nodes, Node{name, position}, "node", place);
}

MemberId ModelDraft::add_member(const MemberDraft& draft, const JsonValue& place) {
  check_part_name(draft.name, place);
  check_groups(draft.groups, place);
  if (keep_descriptions) member_descriptions.push_back(place);
  Member member;
  member.name = draft.name;
  member.kind = draft.kind;
  member.nodes = draft.nodes;
  member.section = draft.section;
  member.material = draft.material;
  member.offsets = draft.offsets;
  member.axial = draft.axial;
  member.design = draft.design;
  member.groups = draft.groups;
  const std::array<Vec3, 2> ends{building[draft.nodes[0]].position + draft.offsets[0],
                                 building[draft.nodes[1]].position + draft.offsets[1]};
  const Vec3 along = ends[1] - ends[0];
  member.length = along.norm();
  if (!(member.length > 1e-12 * (ends[0].norm() + ends[1].norm())) || !std::isfinite(member.length))
    place.fail("the member has no length (its ends are in one place); accepted: two ends apart from each other");
  for (const double at : draft.design.restraints)
    if (!(at > 0 && at < member.length))
      place.fail("`restraints` of its `design` lie beyond its ends; accepted: distances from the first end inside it");
  const auto axes = member_axes(along, draft.up, draft.roll);
  if (!axes) place.fail("`up` is along the member's axis; accepted: a direction at least 1e-6 rad away from it");
  member.axes = *axes;
  const MemberId id(building.members.size());
  for (int end = 0; end < 2; ++end) {
    Joint joint;
    joint.name = draft.name + (end == 0 ? ":1" : ":2");
    joint.member = id;
    joint.end = end;
    if (const JointTypeId type = draft.joints[static_cast<std::size_t>(end)]; type.valid()) {
      joint.capacity = capacity_of(type, draft.section, draft.material, place);
      const JointType& description = joint_types[index_of(type)];
      if (description.stiffness) joint.stiffness = *description.stiffness;
    }
    member_joints_.push_back(std::move(joint));
  }
  return add_named(members_, building.members, std::move(member), "member", place);
}

PanelId ModelDraft::add_panel(PanelDraft draft, const JsonValue& place) {
  constexpr std::int64_t most_mesh_nodes = 500'000;  // their equations and factor take some 10 GB
  if (draft.panel.model == PanelModel::shell)
    mesh_nodes_ += (std::int64_t{draft.panel.mesh[0]} + 1) * (std::int64_t{draft.panel.mesh[1]} + 1);
  if (mesh_nodes_ > most_mesh_nodes)
    place.fail("the meshes of shells come to " + std::to_string(mesh_nodes_) + " nodes here; accepted: at most " +
               std::to_string(most_mesh_nodes) + " in the whole model");
  Panel& panel = draft.panel;
  check_part_name(panel.name, place);
  check_groups(panel.groups, place);
  if (keep_descriptions) panel_descriptions.push_back(place);
  std::array<Vec3, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = building[panel.nodes[i]].position;
  const PanelGeometry geometry = panel_geometry(corners);
  if (!geometry.convex)
    place.fail("the four nodes do not go round a convex quadrilateral; accepted: four corners in order");
  if (geometry.warp > (panel.model == PanelModel::shell ? largest_warp_of_shells : largest_warp))
    place.fail("the panel is warped by " + std::to_string(100 * geometry.warp) +
               " % of its longer diagonal; accepted: at most 10 % for shells, 1 % for other panels");
  panel.axes = geometry.axes;
  std::array<Vec2, 4> outline;
  for (std::size_t i = 0; i < 4; ++i) outline[i] = (panel.axes * (corners[i] - corners[0])).head<2>();
  for (const auto& opening : panel.openings)
    if (const std::string fault = opening_fault(opening, outline); !fault.empty()) place.fail(fault);
  const Material& material = building[panel.material];
  if (!(material.poisson_ratio > -1 && material.poisson_ratio <= 0.5))
    place.fail("its material " + in_quotes(material.name) + " has Poisson's ratio " +
               std::to_string(material.poisson_ratio) + "; accepted for panels: above -1, at most 0.5");
  const PanelId id(building.panels.size());
  for (int edge = 0; edge < 4; ++edge) {
    Joint joint;
    joint.name = panel.name + ":" + std::to_string(edge + 1);
    joint.panel = id;
    joint.end = edge;
    if (draft.joint.valid()) {
      const JointType& type = joint_types[index_of(draft.joint)];
      joint.capacity = edge_capacity(type, place);
      if (type.stiffness && panel.model != PanelModel::shell)
        place.fail("its joint " + in_quotes(type.name) + " has `stiffness`; accepted for membrane and cladding: none");
      if (type.stiffness) joint.stiffness = *type.stiffness;
    }
    panel_joints_.push_back(std::move(joint));
  }
  return add_named(panels_, building.panels, std::move(panel), "panel", place);
}

MaterialId ModelDraft::add_material(Material material, const JsonValue& place) {
  return add_named(materials_, building.materials, std::move(material), "material", place);
}

SectionId ModelDraft::add_section(Section section, const JsonValue& place) {
  return add_named(sections_, building.sections, std::move(section), "section", place);
}

void ModelDraft::add_joint_type(JointType type, const JsonValue& place) {
  add_named(joint_type_names_, joint_types, std::move(type), "joint", place);
}

void ModelDraft::add_case(const std::string& name, const JsonValue& place) {
  LoadCase load_case;
  load_case.name = name;
  add_named(cases_, building.cases, std::move(load_case), "load case", place);
}

void ModelDraft::add_support(const NodeSupport& support, const JsonValue& place) {
  std::int32_t& index = support_of_node_[index_of(support.node)];
  if (index >= 0)
    place.fail("the node " + in_quotes(building[support.node].name) +
               " has a support already; accepted: one for each node");
  index = static_cast<std::int32_t>(building.supports.size());
  building.supports.push_back(support);
}

const NodeSupport* ModelDraft::support_of(NodeId node) const {
  const std::int32_t index = support_of_node_[index_of(node)];
  return index < 0 ? nullptr : &building.supports[static_cast<std::size_t>(index)];
}

void ModelDraft::require_room(const JsonValue& place, double more) const {
  constexpr double most = 4e6;  // a part takes about a kilobyte
  const double all =
      static_cast<double>(building.nodes.size() + building.members.size() + building.panels.size()) + more;
  if (!(all <= most))
    place.fail("the model would have " + std::to_string(static_cast<std::int64_t>(std::min(all, 1e18))) +
               " nodes, members and panels; accepted: at most " + std::to_string(static_cast<std::int64_t>(most)));
}

void ModelDraft::reserve(std::size_t nodes, std::size_t members) {
  building.nodes.reserve(building.nodes.size() + nodes);
  nodes_.reserve(nodes);
  building.members.reserve(building.members.size() + members);
  members_.reserve(members);
  member_joints_.reserve(member_joints_.size() + 2 * members);
}

void ModelDraft::finish_joints() {
  building.joints = std::move(member_joints_);
  building.joints.insert(building.joints.end(), std::make_move_iterator(panel_joints_.begin()),
                         std::make_move_iterator(panel_joints_.end()));
}

NodeId ModelDraft::node(const JsonValue& name) const {
  return look_up(nodes_, building.nodes, name.text("the name of a node"), "node", name);
}
SectionId ModelDraft::section(const JsonValue& name) const {
  return look_up(sections_, building.sections, name.text("the name of a section"), "section", name);
}
MaterialId ModelDraft::material(const JsonValue& name) const {
  return look_up(materials_, building.materials, name.text("the name of a material"), "material", name);
}
JointTypeId ModelDraft::joint_type(const JsonValue& name) const {
  if (name.is_null()) return {};
  return look_up(joint_type_names_, joint_types, name.text("the name of a joint, or null"), "joint", name);
}
NodeId ModelDraft::node_of_key(const JsonValue& value) const {
  return look_up(nodes_, building.nodes, value.key(), "node", value);
}
MemberId ModelDraft::member_of_key(const JsonValue& value) const {
  return look_up(members_, building.members, value.key(), "member", value);
}
PanelId ModelDraft::panel_of_key(const JsonValue& value) const {
  return look_up(panels_, building.panels, value.key(), "panel", value);
}
LoadCaseId ModelDraft::case_of_key(const JsonValue& value) const {
  return look_up(cases_, building.cases, value.key(), "load case", value);
}

const JointCapacity& ModelDraft::capacity_of(JointTypeId type_id, SectionId section, MaterialId material,
                                             const JsonValue& place) {
  const auto key = std::tuple(type_id, section, material);
  if (const auto known = capacities_.find(key); known != capacities_.end()) return known->second;
  const JointType& type = joint_types[index_of(type_id)];
  if (!type.has_capacity && type.per_length)
    place.fail("its joint " + in_quotes(type.name) + " has `capacity_per_length`; accepted for a member: `capacity`");
  JointCapacity capacity;
  capacity.breakable = type.has_capacity;
  capacity.ductility = type.ductility;
  capacity.interaction = type.interaction.value_or(Interaction::max);
  for (std::size_t s = 0; s < 7; ++s) {
    if (type.given[s]) {
      capacity.value[s] = *type.given[s] * type.strength;
    } else if (type.from_section) {
      const SectionCapacity whole = section_capacity(building[section], building[material], static_cast<Sense>(s));
      const auto need = [&](const std::string& kind, const std::string& name, const std::string& missing) {
        place.fail("its joint " + in_quotes(type.name) + " takes its capacity from the section, for which " + kind +
                   "." + name + "." + missing + " is missing; accepted: that key, or `" + sense_names[s] +
                   "` in the joint's capacity");
      };
      if (!whole.missing_of_section.empty()) need("sections", building[section].name, whole.missing_of_section);
      if (!whole.missing_of_material.empty()) need("materials", building[material].name, whole.missing_of_material);
      capacity.value[s] = whole.value * type.ratio * type.strength;
    }
  }
  return capacities_.emplace(key, capacity).first->second;
}

JointCapacity ModelDraft::edge_capacity(const JointType& type, const JsonValue& place) const {
  if (type.has_capacity && !type.per_length)
    place.fail("its joint " + in_quotes(type.name) +
               " has `capacity`; accepted for a panel's edges: `capacity_per_length`");
  JointCapacity capacity;
  capacity.breakable = type.per_length.has_value();
  capacity.ductility = type.ductility;
  capacity.interaction = type.interaction.value_or(Interaction::max);
  if (type.per_length)
    for (std::size_t s = 0; s < 7; ++s) capacity.value[s] = (*type.per_length)[s] * type.strength;
  return capacity;
}

}  // namespace topple::structure::formats
