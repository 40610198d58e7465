#pragma once
// A model while it is being read: the building so far, what its names mean, and the factors to SI. Parts are added
// through here by the reader of members and panels and by the building generator, so that both obey the same checks.
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "formats/json/json_document.h"
#include "topple/structure/building.h"

namespace topple::structure::formats {

/// Storeys that a generator builds at most.
inline constexpr std::int64_t most_storeys = 10'000;

/// Factors from the file's units to SI.
struct Scale {
  double length = 1, force = 1, mass = 1;
  [[nodiscard]] double moment() const { return force * length; }
  [[nodiscard]] double area() const { return length * length; }
  [[nodiscard]] double modulus() const { return length * length * length; }
  [[nodiscard]] double inertia() const { return area() * area(); }
  [[nodiscard]] double stress() const { return force / area(); }
  [[nodiscard]] double density() const { return mass / modulus(); }
  [[nodiscard]] double spring() const { return force / length; }
  /// Of the six components of a load, a spring, a movement.
  [[nodiscard]] double load(int component) const { return component < 3 ? force : moment(); }
  [[nodiscard]] double stiffness(int component) const { return component < 3 ? spring() : moment(); }
  [[nodiscard]] double movement(int component) const { return component < 3 ? length : 1; }
};

/// The number at `value` (checked by the caller or not) times a factor; a product that is not finite is refused.
[[nodiscard]] double scaled(const JsonValue& value, double factor);

/// Names of one kind of thing.
template <class Id>
class Names {
 public:
  /// False when the name is already there.
  bool add(std::string_view name, Id id) { return map_.emplace(name, id).second; }
  [[nodiscard]] std::optional<Id> find(std::string_view name) const {
    const auto found = map_.find(name);
    if (found == map_.end()) return std::nullopt;
    return found->second;
  }
  [[nodiscard]] std::size_t size() const { return map_.size(); }
  void reserve(std::size_t more) { map_.reserve(map_.size() + more); }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
  };
  std::unordered_map<std::string, Id, Hash, std::equal_to<>> map_;  // looked up only, never walked through
};

/// A joint type of the file: what it becomes depends on the section and material of the member that uses it.
struct JointType {
  std::string name;
  std::optional<Vec6> stiffness;
  bool has_capacity = false, from_section = false;
  double ratio = 1, strength = 1;
  std::array<std::optional<double>, 7> given;       ///< in `capacity`
  std::optional<std::array<double, 7>> per_length;  ///< `capacity_per_length`
  std::optional<Interaction> interaction;
  std::array<double, 7> ductility{};
};

struct MemberDraft {
  std::string name;
  MemberKind kind = MemberKind::beam;
  std::array<NodeId, 2> nodes;
  SectionId section;
  MaterialId material;
  std::array<JointTypeId, 2> joints;  ///< not valid: rigid and never breaks
  std::array<Vec3, 2> offsets{Vec3::Zero(), Vec3::Zero()};
  std::optional<Vec3> up;
  double roll = 0;
  AxialAction axial = AxialAction::both;
  MemberDesign design;
  std::vector<std::string> groups;
};

struct PanelDraft {
  Panel panel;        ///< axes are found when it is added
  JointTypeId joint;  ///< not valid: never breaks
};

class ModelDraft {
 public:
  Building building;
  Scale scale;
  std::vector<JointType> joint_types;

  /// Where each member and panel is described, in their order (a generator's rule stands for all that it makes); filled
  /// when it is asked for before they are added.
  bool keep_descriptions = false;
  std::vector<JsonValue> member_descriptions, panel_descriptions;

  /// Room for so many more, so that large models do not move what is there again and again.
  void reserve(std::size_t nodes, std::size_t members);
  /// Refuses, before anything is made, what would bring the whole model beyond what can be held: `more` nodes, members
  /// and panels together. A short file can ask for any number of them.
  void require_room(const JsonValue& place, double more) const;

  // `place` is where the part is described, for messages.
  NodeId add_node(const std::string& name, const Vec3& position, const JsonValue& place);
  MemberId add_member(const MemberDraft& draft, const JsonValue& place);
  PanelId add_panel(PanelDraft draft, const JsonValue& place);
  MaterialId add_material(Material material, const JsonValue& place);
  SectionId add_section(Section section, const JsonValue& place);
  void add_joint_type(JointType type, const JsonValue& place);
  void add_case(const std::string& name, const JsonValue& place);
  /// Refuses a second support of one node.
  void add_support(const NodeSupport& support, const JsonValue& place);
  /// Puts the joints in their order; to be called once, when all parts are there.
  void finish_joints();

  // What a name in the file stands for; throws with what is accepted.
  [[nodiscard]] NodeId node(const JsonValue& name) const;
  [[nodiscard]] SectionId section(const JsonValue& name) const;
  [[nodiscard]] MaterialId material(const JsonValue& name) const;
  /// null becomes an id that is not valid.
  [[nodiscard]] JointTypeId joint_type(const JsonValue& name) const;
  // The same for names that stand as keys of an object.
  [[nodiscard]] NodeId node_of_key(const JsonValue& value) const;
  [[nodiscard]] MemberId member_of_key(const JsonValue& value) const;
  [[nodiscard]] PanelId panel_of_key(const JsonValue& value) const;
  [[nodiscard]] LoadCaseId case_of_key(const JsonValue& value) const;
  [[nodiscard]] std::optional<NodeId> find_node(std::string_view name) const { return nodes_.find(name); }
  [[nodiscard]] std::optional<PanelId> find_panel(std::string_view name) const { return panels_.find(name); }
  /// Support of a node; null: it has none.
  [[nodiscard]] const NodeSupport* support_of(NodeId node) const;

 private:
  std::int64_t mesh_nodes_ = 0;  ///< of all shells
  void check_name(const std::string& name, const JsonValue& place) const;
  void check_part_name(const std::string& name, const JsonValue& place) const;
  [[nodiscard]] const JointCapacity& capacity_of(JointTypeId type, SectionId section, MaterialId material,
                                                 const JsonValue& place);
  [[nodiscard]] JointCapacity edge_capacity(const JointType& type, const JsonValue& place) const;

  Names<NodeId> nodes_;
  Names<MemberId> members_;
  Names<PanelId> panels_;
  Names<MaterialId> materials_;
  Names<SectionId> sections_;
  Names<JointTypeId> joint_type_names_;
  Names<LoadCaseId> cases_;
  std::vector<std::int32_t> support_of_node_;  ///< index in building.supports, -1: none
  std::vector<Joint> member_joints_, panel_joints_;
  std::map<std::tuple<JointTypeId, SectionId, MaterialId>, JointCapacity> capacities_;
};

}  // namespace topple::structure::formats
