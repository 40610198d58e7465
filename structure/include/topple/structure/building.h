#pragma once
// The building as it was read or generated: immutable input for analysis and simulation. SI units (unless the model
// says "consistent"), global z up. Names, defaults and meanings are those of the model format (docs/model-format.md).
#include <Eigen/Core>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "topple/fracture/panel_settings.h"
#include "topple/structure/ids.h"

namespace topple::structure {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;  ///< x, y, z, rx, ry, rz

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Names of the six components, in order.
inline constexpr std::array<const char*, 6> component_names{"x", "y", "z", "rx", "ry", "rz"};

/// Factors from the model's units to SI, and their names for output. `consistent`: all factors 1, names are
/// "consistent".
struct Units {
  double length = 1, force = 1, mass = 1;
  std::string length_name = "m", force_name = "N", mass_name = "kg";
  bool consistent = false;
};

struct Material {
  std::string name;
  double youngs_modulus = 0, shear_modulus = 0, poisson_ratio = 0, density = 0;
  std::optional<double> yield_strength, compressive_strength, tensile_strength, thermal_expansion;
  std::optional<fracture::PanelSettings> fracture;  ///< of panels of this material that have none of their own
};

/// Cross section: depth along local z, width along local y. Numbers that a raw section leaves out stay empty.
struct Section {
  enum class Shape { numbers, I, box, rectangle, circle, pipe };
  std::string name;
  Shape shape = Shape::numbers;
  std::string catalogue;  ///< catalogue name, when it came from there
  // Dimensions for drawing, capacities and collision; 0 where the shape has none.
  double depth = 0, width = 0, web = 0, flange = 0, fillet = 0, thickness = 0;
  // Properties. Iy is about local y (strong axis of an upright I), Iz about local z.
  double area = 0, Iy = 0, Iz = 0, J = 0;
  double shear_area_y = 0, shear_area_z = 0;  ///< 0: no shear deformation
  std::optional<double> plastic_modulus_y, plastic_modulus_z, torsion_modulus;
  /// Areas that carry shear at first yield, for derived capacities (EN 1993-1-1 6.2.6(3) and kin).
  std::optional<double> plastic_shear_area_y, plastic_shear_area_z;
};

/// The seven ways in which a joint can fail: the components of its capacity.
enum class Sense { tension, compression, shear_y, shear_z, torsion, moment_y, moment_z };
inline constexpr std::array<const char*, 7> sense_names{"tension", "compression", "shear_y", "shear_z",
                                                        "torsion", "moment_y",    "moment_z"};

/// `max`: the largest of the seven ratios. `sum`: N/Nc + My/Myc + Mz/Mzc, shear and torsion apart.
enum class Interaction { max, sum };

/// What one joint can bear, already multiplied by its `strength`, for its own member's section and material. For a
/// panel's edge the four forces are per unit length of edge.
struct JointCapacity {
  std::array<double, 7> value{unlimited, unlimited, unlimited, unlimited, unlimited, unlimited, unlimited};
  Interaction interaction = Interaction::max;
  std::array<double, 7> ductility{};  ///< plastic rotation (rad) held before the joint breaks; 0: brittle
  bool breakable = false;             ///< false: no capacity was given, it never breaks
};

/// A member end or panel edge as the building has it.
struct Joint {
  std::string name;                            ///< "PA:1", "S1:3"
  MemberId member;                             ///< valid for a member end ...
  PanelId panel;                               ///< ... or a panel's edge
  int end = 0;                                 ///< 0 or 1 (first, second end); edges 0 to 3
  Vec6 stiffness = Vec6::Constant(unlimited);  ///< unlimited: rigid, 0: released, else a spring
  JointCapacity capacity;
};

enum class MemberKind { post, beam, brace };
enum class AxialAction { both, tension, compression };

/// What a design check needs to know of a member beside its section: the `design` of the model format. What is left out
/// is found from the model, or taken on the safe side (docs/design-checks.md).
struct MemberDesign {
  bool checked = true;
  /// Effective lengths for flexural buckling about y, about z, and torsional buckling: as lengths, or as multiples of
  /// the member's length. 0: it cannot buckle so.
  std::array<std::optional<double>, 3> lengths, factors;
  bool restrained_throughout = false;  ///< the compression flange is held all along
  std::vector<double> restraints;      ///< where it is held between the ends: distances from the first end
  double moment_factor = 1;            ///< C1 of EN 1993-1-1, Cb of AISC 360
  double equivalent_moment_y = 1, equivalent_moment_z = 1;  ///< C_my (and C_mLT), C_mz of EN 1993-1-1 annex B
  double stiffener_spacing = 0;  ///< of transverse stiffeners of the web, m; 0: at the supports alone
};

struct Member {
  std::string name;
  MemberKind kind = MemberKind::beam;
  std::array<NodeId, 2> nodes;
  SectionId section;
  MaterialId material;
  std::array<Vec3, 2> offsets{Vec3::Zero(), Vec3::Zero()};  ///< rigid arms, global
  Mat3 axes = Mat3::Identity();                             ///< rows: local x, y, z
  double length = 0;                                        ///< between the ends, after the offsets
  AxialAction axial = AxialAction::both;
  MemberDesign design;
  std::vector<std::string> groups;  ///< beside the one of its kind
};

enum class PanelKind { slab, wall };
enum class PanelModel { membrane, cladding, shell };
enum class Span { two_way, x, y };

struct Panel {
  std::string name;
  PanelKind kind = PanelKind::slab;
  PanelModel model = PanelModel::membrane;
  std::array<NodeId, 4> nodes;
  double thickness = 0;
  MaterialId material;
  Span span = Span::two_way;
  std::array<int, 2> mesh{1, 1};
  std::vector<std::vector<Vec2>> openings;  ///< polygons in local x, y from node 1
  Mat3 axes = Mat3::Identity();             ///< rows: local x (node 1 to 2), y, z (normal)
  std::vector<std::string> groups;
  std::optional<fracture::PanelSettings> fracture;  ///< none: its material's
  // Of a shell that is readied for demolition (join_shells.h):
  /// Per edge: nodes of the building between its corners that are nodes of the panel's mesh, from node i to i + 1.
  std::array<std::vector<NodeId>, 4> edge_nodes;
  std::array<bool, 4> joined{};  ///< per edge: a member or another shell lies along it

  /// Corners, then edge_nodes edge by edge.
  [[nodiscard]] std::vector<NodeId> all_nodes() const {
    std::vector<NodeId> all(nodes.begin(), nodes.end());
    for (const auto& on_edge : edge_nodes) all.insert(all.end(), on_edge.begin(), on_edge.end());
    return all;
  }
};

/// Per component: 0 free, `unlimited` held, else a spring stiffness; global axes.
struct NodeSupport {
  NodeId node;
  Vec6 stiffness = Vec6::Zero();
};
struct EdgeSupport {
  PanelId panel;
  int edge = 0;
  Vec6 stiffness = Vec6::Zero();
};

struct Diaphragm {
  std::string name;
  std::vector<NodeId> nodes;
};

enum class LoadFrame { global, local, projected };

struct MemberLoad {
  enum class Kind { distributed, point, temperature };
  MemberId member;
  Kind kind = Kind::distributed;
  LoadFrame frame = LoadFrame::global;
  double from = 0, to = 0;                                 ///< point: `from` is the place
  Vec6 first = Vec6::Zero(), last = Vec6::Zero();          ///< intensity at from and to; point: `first`
  double temperature = 0, gradient_y = 0, gradient_z = 0;  ///< K and K per length
};
struct PanelLoad {
  PanelId panel;
  double pressure = 0;     ///< acts against the normal
  double temperature = 0;  ///< K
};
struct NodeLoad {
  NodeId node;
  Vec6 load = Vec6::Zero();
};
struct Settlement {
  NodeId node;
  int component = 0;
  double value = 0;
};

struct LoadCase {
  std::string name;
  Vec3 self_weight = Vec3::Zero();  ///< multiple of gravity as a direction: (0, 0, -1) is the weight
  std::vector<MemberLoad> members;
  std::vector<PanelLoad> panels;
  std::vector<NodeLoad> nodes;
  std::vector<Settlement> settlements;
};

struct Combination {
  std::string name;
  std::vector<std::pair<LoadCaseId, double>> factors;
};

struct NodeMass {
  NodeId node;
  double mass = 0;
  Vec3 inertia = Vec3::Zero();
};
struct MassSources {
  std::vector<NodeMass> nodes;
  std::vector<std::pair<MemberId, double>> members;
  std::vector<std::pair<LoadCaseId, double>> loads;
};

/// Analyses that the file itself asks for (a Frame3DD file does so by its flags). Options of the caller come on top.
struct RequestedAnalyses {
  bool cubic_p_delta = false;
  int modes = 0;
  bool lumped_mass = false;
  double frequency_shift = 0;              ///< of the eigenvalue (rad/s)^2, for structures that float
  bool modes_of_last_combination = false;  ///< modes about the tangent stiffness of the last combination
};

struct Node {
  std::string name;
  Vec3 position = Vec3::Zero();
};

/// The building as a whole.
struct Building {
  std::string title, file;
  Units units;
  double gravity = 9.80665;
  std::vector<Material> materials;
  std::vector<Section> sections;
  std::vector<Node> nodes;
  std::vector<Member> members;
  std::vector<Panel> panels;
  /// 2 for each member (first end, second end), then 4 for each panel (edge i from its node i to i + 1).
  std::vector<Joint> joints;
  std::vector<NodeSupport> supports;
  std::vector<EdgeSupport> edge_supports;
  std::vector<Diaphragm> diaphragms;
  MassSources masses;
  std::vector<LoadCase> cases;
  std::vector<Combination> combinations;
  RequestedAnalyses requested;
  std::vector<std::string> warnings;

  [[nodiscard]] JointId joint(MemberId member, int end) const {
    return JointId(static_cast<std::size_t>(2 * member.index + end));
  }
  [[nodiscard]] JointId joint(PanelId panel, int edge) const {
    return JointId(2 * members.size() + static_cast<std::size_t>(4 * panel.index + edge));
  }
  const Node& operator[](NodeId id) const { return nodes[static_cast<std::size_t>(id.index)]; }
  const Member& operator[](MemberId id) const { return members[static_cast<std::size_t>(id.index)]; }
  const Panel& operator[](PanelId id) const { return panels[static_cast<std::size_t>(id.index)]; }
  const Material& operator[](MaterialId id) const { return materials[static_cast<std::size_t>(id.index)]; }
  const Section& operator[](SectionId id) const { return sections[static_cast<std::size_t>(id.index)]; }
  const Joint& operator[](JointId id) const { return joints[static_cast<std::size_t>(id.index)]; }
  const LoadCase& operator[](LoadCaseId id) const { return cases[static_cast<std::size_t>(id.index)]; }
  const Combination& operator[](CombinationId id) const { return combinations[static_cast<std::size_t>(id.index)]; }
};

/// True when `name` matches `pattern`, in which '*' stands for any run of characters.
[[nodiscard]] bool matches_pattern(std::string_view pattern, std::string_view name);

/// Looks names up; patterns may hold '*' for any run of characters. Built once for a building.
class NameIndex {
 public:
  explicit NameIndex(const Building& building);
  [[nodiscard]] std::optional<NodeId> node(const std::string& name) const;
  [[nodiscard]] std::optional<MemberId> member(const std::string& name) const;
  [[nodiscard]] std::optional<PanelId> panel(const std::string& name) const;
  [[nodiscard]] std::optional<JointId> joint(const std::string& name) const;
  [[nodiscard]] std::vector<NodeId> nodes_matching(const std::string& pattern) const;
  [[nodiscard]] std::vector<MemberId> members_matching(const std::string& pattern) const;
  [[nodiscard]] std::vector<PanelId> panels_matching(const std::string& pattern) const;
  [[nodiscard]] std::vector<JointId> joints_matching(const std::string& pattern) const;
  struct Group {
    std::vector<MemberId> members;
    std::vector<PanelId> panels;
  };
  /// posts, beams, braces, slabs, walls, and the named ones; null when there is no such group.
  [[nodiscard]] const Group* group(const std::string& name) const;

 private:
  std::map<std::string, NodeId> nodes_;
  std::map<std::string, MemberId> members_;
  std::map<std::string, PanelId> panels_;
  std::map<std::string, JointId> joints_;
  std::map<std::string, Group> groups_;
};

}  // namespace topple::structure
