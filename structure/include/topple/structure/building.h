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
  double length = 1;              ///< m per unit of length
  double force = 1;               ///< N per unit of force
  double mass = 1;                ///< kg per unit of mass
  std::string length_name = "m";  ///< for output
  std::string force_name = "N";   ///< for output
  std::string mass_name = "kg";   ///< for output
  bool consistent = false;        ///< true: the file names no units
};

/// A linear elastic material, with what its members' capacities and panels' cracking need.
struct Material {
  std::string name;                                 ///< unique among materials
  double youngs_modulus = 0;                        ///< E, Pa
  double shear_modulus = 0;                         ///< G, Pa
  double poisson_ratio = 0;                         ///< nu
  double density = 0;                               ///< kg/m3
  std::optional<double> yield_strength;             ///< Pa
  std::optional<double> compressive_strength;       ///< Pa
  std::optional<double> tensile_strength;           ///< Pa
  std::optional<double> thermal_expansion;          ///< strain per kelvin
  std::optional<fracture::PanelSettings> fracture;  ///< of panels of this material that have none of their own
};

/// Cross section: depth along local z, width along local y. Numbers that a raw section leaves out stay empty.
struct Section {
  /// What the section was made from; numbers: properties alone.
  enum class Shape { numbers, I, box, rectangle, circle, pipe };
  std::string name;              ///< unique among sections
  Shape shape = Shape::numbers;  ///< which dimensions count
  std::string catalogue;         ///< catalogue name, when it came from there
  // Dimensions for drawing, capacities and collision; 0 where the shape has none.
  double depth = 0;      ///< m, along local z
  double width = 0;      ///< m, along local y
  double web = 0;        ///< thickness, m
  double flange = 0;     ///< thickness, m
  double fillet = 0;     ///< radius, m
  double thickness = 0;  ///< of a box's or pipe's wall, m
  // Properties. Iy is about local y (strong axis of an upright I), Iz about local z.
  double area = 0;                          ///< m2
  double Iy = 0;                            ///< m4
  double Iz = 0;                            ///< m4
  double J = 0;                             ///< Saint-Venant torsion constant, m4
  double shear_area_y = 0;                  ///< m2, for forces along local y; 0: no shear deformation
  double shear_area_z = 0;                  ///< m2, for forces along local z; 0: no shear deformation
  std::optional<double> plastic_modulus_y;  ///< m3
  std::optional<double> plastic_modulus_z;  ///< m3
  std::optional<double> torsion_modulus;    ///< torque over largest shear stress, m3
  /// Areas that carry shear at first yield, for derived capacities (EN 1993-1-1 6.2.6(3) and kin).
  std::optional<double> plastic_shear_area_y;  ///< m2, along local y
  std::optional<double> plastic_shear_area_z;  ///< m2, along local z
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
  std::array<double, 7> value{unlimited, unlimited, unlimited, unlimited,
                              unlimited, unlimited, unlimited};  ///< N and N m, by Sense
  Interaction interaction = Interaction::max;                    ///< how demands of several senses are put together
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
  JointCapacity capacity;                      ///< as read, or derived from the member's section
};

enum class MemberKind { post, beam, brace };
enum class AxialAction { both, tension, compression };

/// What a design check needs to know of a member beside its section: the `design` of the model format. What is left out
/// is found from the model, or taken on the safe side (docs/design-checks.md).
struct MemberDesign {
  bool checked = true;  ///< false: the member is left out
  /// Effective lengths for flexural buckling about y, about z, and torsional buckling: as lengths, or as multiples of
  /// the member's length. 0: it cannot buckle so.
  std::array<std::optional<double>, 3> lengths;  ///< see above; m
  std::array<std::optional<double>, 3> factors;  ///< see above; multiples of the member's length
  bool restrained_throughout = false;            ///< the compression flange is held all along
  std::vector<double> restraints;                ///< where it is held between the ends: distances from the first end
  double moment_factor = 1;                      ///< C1 of EN 1993-1-1, Cb of AISC 360
  double equivalent_moment_y = 1;                ///< C_my and C_mLT of EN 1993-1-1 annex B
  double equivalent_moment_z = 1;                ///< C_mz of EN 1993-1-1 annex B
  double stiffener_spacing = 0;                  ///< of transverse stiffeners of the web, m; 0: at the supports alone
};

/// A straight bar between two nodes.
struct Member {
  std::string name;                                         ///< unique among members
  MemberKind kind = MemberKind::beam;                       ///< as given, or by its direction
  std::array<NodeId, 2> nodes;                              ///< first end, second end
  SectionId section;                                        ///< index in Building::sections
  MaterialId material;                                      ///< index in Building::materials
  std::array<Vec3, 2> offsets{Vec3::Zero(), Vec3::Zero()};  ///< rigid arms, global
  Mat3 axes = Mat3::Identity();                             ///< rows: local x, y, z
  double length = 0;                                        ///< between the ends, after the offsets
  AxialAction axial = AxialAction::both;                    ///< which sign of axial force it carries
  MemberDesign design;                                      ///< for design checks
  std::vector<std::string> groups;                          ///< beside the one of its kind
};

enum class PanelKind { slab, wall };
enum class PanelModel { membrane, cladding, shell };
enum class Span { two_way, x, y };

/// A flat quadrilateral between four nodes.
struct Panel {
  std::string name;                                 ///< unique among panels
  PanelKind kind = PanelKind::slab;                 ///< as given, or by its direction
  PanelModel model = PanelModel::membrane;          ///< how it takes part
  std::array<NodeId, 4> nodes;                      ///< counter-clockwise against the normal
  double thickness = 0;                             ///< m
  MaterialId material;                              ///< index in Building::materials
  Span span = Span::two_way;                        ///< which way a slab that is no shell hands on its loads
  std::array<int, 2> mesh{1, 1};                    ///< elements along local x and y, of a shell
  std::vector<std::vector<Vec2>> openings;          ///< polygons in local x, y from node 1
  Mat3 axes = Mat3::Identity();                     ///< rows: local x (node 1 to 2), y, z (normal)
  std::vector<std::string> groups;                  ///< beside the one of its kind
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
  NodeId node;                    ///< the supported node
  Vec6 stiffness = Vec6::Zero();  ///< x y z rx ry rz: N/m, N m/rad
};
/// A support along a whole edge of a shell panel. Stiffness as in NodeSupport, at each node of the edge.
struct EdgeSupport {
  PanelId panel;                  ///< a shell panel
  int edge = 0;                   ///< 0 to 3, from node i to i + 1
  Vec6 stiffness = Vec6::Zero();  ///< x y z rx ry rz
};

/// Nodes that move together in the global x-y plane.
struct Diaphragm {
  std::string name;           ///< unique among diaphragms
  std::vector<NodeId> nodes;  ///< at least two
};

enum class LoadFrame { global, local, projected };

/// A load on one member.
struct MemberLoad {
  /// line load, load at a place, or temperature
  enum class Kind { distributed, point, temperature };
  MemberId member;                      ///< that bears it
  Kind kind = Kind::distributed;        ///< which of the numbers below count
  LoadFrame frame = LoadFrame::global;  ///< axes, and length that a line load counts on
  double from = 0;                      ///< m from the first end
  double to = 0;                        ///< point: `from` is the place
  Vec6 first = Vec6::Zero();            ///< at `from`: N/m and N m/m, or N and N m
  Vec6 last = Vec6::Zero();             ///< at `to`: N/m and N m/m
  double temperature = 0;               ///< K
  double gradient_y = 0;                ///< K/m along local y
  double gradient_z = 0;                ///< K/m along local z
};
/// A load on one panel.
struct PanelLoad {
  PanelId panel;           ///< that bears it
  double pressure = 0;     ///< acts against the normal
  double temperature = 0;  ///< K
};
/// A load on one node.
struct NodeLoad {
  NodeId node;               ///< that bears it
  Vec6 load = Vec6::Zero();  ///< N and N m, global axes
};
/// A displacement imposed on a support.
struct Settlement {
  NodeId node;        ///< a supported node
  int component = 0;  ///< 0 to 5: x y z rx ry rz
  double value = 0;   ///< m or rad
};

/// Loads that act together.
struct LoadCase {
  std::string name;                     ///< unique among load cases
  Vec3 self_weight = Vec3::Zero();      ///< multiple of gravity as a direction: (0, 0, -1) is the weight
  std::vector<MemberLoad> members;      ///< on members
  std::vector<PanelLoad> panels;        ///< on panels
  std::vector<NodeLoad> nodes;          ///< on nodes
  std::vector<Settlement> settlements;  ///< of supports
};

/// A sum of load cases with factors.
struct Combination {
  std::string name;                                    ///< unique among combinations
  std::vector<std::pair<LoadCaseId, double>> factors;  ///< case and its factor
};

/// Mass at a node that is no load.
struct NodeMass {
  NodeId node;                  ///< that has it
  double mass = 0;              ///< kg
  Vec3 inertia = Vec3::Zero();  ///< kg m2, about the global axes through the node
};
/// Masses for modes and motion beside those by density.
struct MassSources {
  std::vector<NodeMass> nodes;                       ///< at nodes
  std::vector<std::pair<MemberId, double>> members;  ///< spread along members, kg each
  std::vector<std::pair<LoadCaseId, double>> loads;  ///< downward loads of these cases over gravity, times the factor
};

/// Analyses that the file itself asks for (a Frame3DD file does so by its flags). Options of the caller come on top.
struct RequestedAnalyses {
  bool cubic_p_delta = false;              ///< second order by the cubic geometric stiffness
  int modes = 0;                           ///< how many natural modes
  bool lumped_mass = false;                ///< true: lumped, else consistent
  double frequency_shift = 0;              ///< of the eigenvalue (rad/s)^2, for structures that float
  bool modes_of_last_combination = false;  ///< modes about the tangent stiffness of the last combination
};

/// A point of the model.
struct Node {
  std::string name;              ///< unique among nodes
  Vec3 position = Vec3::Zero();  ///< m, global axes
};

/// The building as a whole.
struct Building {
  std::string title;                ///< of the model
  std::string file;                 ///< path it was read from, for messages
  Units units;                      ///< that the file speaks in; all numbers here are SI
  double gravity = 9.80665;         ///< m/s2, of `self_weight` and of masses from loads
  std::vector<Material> materials;  ///< in the order of the file
  std::vector<Section> sections;    ///< in the order of the file
  std::vector<Node> nodes;          ///< in the order of the file
  std::vector<Member> members;      ///< in the order of the file
  std::vector<Panel> panels;        ///< in the order of the file
  /// 2 for each member (first end, second end), then 4 for each panel (edge i from its node i to i + 1).
  std::vector<Joint> joints;
  std::vector<NodeSupport> supports;       ///< at most one for each node
  std::vector<EdgeSupport> edge_supports;  ///< of shell panels
  std::vector<Diaphragm> diaphragms;       ///< floors that are rigid in their plane
  MassSources masses;                      ///< beside densities
  std::vector<LoadCase> cases;             ///< at least one
  std::vector<Combination> combinations;   ///< at least one
  RequestedAnalyses requested;             ///< by the file itself
  std::vector<std::string> warnings;       ///< of reading, sentences for a person

  /// The joint of a member's end, 0 or 1.
  [[nodiscard]] JointId joint(MemberId member, int end) const {
    return JointId(static_cast<std::size_t>(2 * member.index + end));
  }
  /// The joint of a panel's edge, 0 to 3.
  [[nodiscard]] JointId joint(PanelId panel, int edge) const {
    return JointId(2 * members.size() + static_cast<std::size_t>(4 * panel.index + edge));
  }
  /// The id must be valid; that is not checked. So for all of these.
  const Node& operator[](NodeId id) const { return nodes[static_cast<std::size_t>(id.index)]; }
  /// See above.
  const Member& operator[](MemberId id) const { return members[static_cast<std::size_t>(id.index)]; }
  /// See above.
  const Panel& operator[](PanelId id) const { return panels[static_cast<std::size_t>(id.index)]; }
  /// See above.
  const Material& operator[](MaterialId id) const { return materials[static_cast<std::size_t>(id.index)]; }
  /// See above.
  const Section& operator[](SectionId id) const { return sections[static_cast<std::size_t>(id.index)]; }
  /// See above.
  const Joint& operator[](JointId id) const { return joints[static_cast<std::size_t>(id.index)]; }
  /// See above.
  const LoadCase& operator[](LoadCaseId id) const { return cases[static_cast<std::size_t>(id.index)]; }
  /// See above.
  const Combination& operator[](CombinationId id) const { return combinations[static_cast<std::size_t>(id.index)]; }
};

/// True when `name` matches `pattern`, in which '*' stands for any run of characters.
[[nodiscard]] bool matches_pattern(std::string_view pattern, std::string_view name);

/// Looks names up; patterns may hold '*' for any run of characters. Built once for a building.
class NameIndex {
 public:
  /// Later changes of the building's names are not seen.
  explicit NameIndex(const Building& building);
  /// By its exact name; none when there is no such node.
  [[nodiscard]] std::optional<NodeId> node(const std::string& name) const;
  /// By its exact name; none when there is no such member.
  [[nodiscard]] std::optional<MemberId> member(const std::string& name) const;
  /// By its exact name; none when there is no such panel.
  [[nodiscard]] std::optional<PanelId> panel(const std::string& name) const;
  /// By its exact name ("PA:1"); none when there is no such joint.
  [[nodiscard]] std::optional<JointId> joint(const std::string& name) const;
  /// In order of their ids; empty when none matches.
  [[nodiscard]] std::vector<NodeId> nodes_matching(const std::string& pattern) const;
  /// In order of their ids; empty when none matches.
  [[nodiscard]] std::vector<MemberId> members_matching(const std::string& pattern) const;
  /// In order of their ids; empty when none matches.
  [[nodiscard]] std::vector<PanelId> panels_matching(const std::string& pattern) const;
  /// In order of their ids; empty when none matches.
  [[nodiscard]] std::vector<JointId> joints_matching(const std::string& pattern) const;
  /// Members and panels under one name.
  struct Group {
    std::vector<MemberId> members;  ///< ascending
    std::vector<PanelId> panels;    ///< ascending
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
