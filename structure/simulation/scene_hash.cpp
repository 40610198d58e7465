#include "simulation/scene_hash.h"

#include <type_traits>

#include "simulation/accounts/replay_hash.h"
#include "topple/structure/snapshot.h"

namespace topple::structure {

namespace {

// Each structure is taken apart whole: a member that is added to one does not compile here until it is looked at.
class SceneHash {
 public:
  template <class... T>
  void each(const T&... values) {
    (add(values), ...);
  }
  [[nodiscard]] std::uint64_t value() const { return hash_.value(); }

 private:
  template <class T>
  requires std::is_floating_point_v<T>
  void add(T value) { hash_.add(static_cast<double>(value)); }
  template <class T>
  requires(std::is_integral_v<T> || std::is_enum_v<T>) void add(T value) {
    hash_.add(static_cast<std::uint64_t>(value));
  }
  void add(const std::string& text) { hash_.add(text); }
  template <class Tag>
  void add(const Id<Tag>& id) {
    add(id.index);
  }
  template <class Derived>
  void add(const Eigen::MatrixBase<Derived>& matrix) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) add(matrix(i, j));
  }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <class T>
  void add(const std::vector<T>& list) {
    add(list.size());
    for (const T& one : list) add(one);
  }
  template <class T, std::size_t n>
  void add(const std::array<T, n>& list) {
    for (const T& one : list) add(one);
  }
  template <class A, class B>
  void add(const std::pair<A, B>& pair) {
    each(pair.first, pair.second);
  }

  void add(const fracture::LocalDamageSettings& settings) {
    const auto& [points, length, ring] = settings;
    each(points, length, ring);
  }
  void add(const fracture::PanelSettings& settings) {
    const auto& [method, cell, jitter, local, seed] = settings;
    each(method, cell, jitter, local, seed);
  }
  void add(const Material& material) {
    const auto& [name, young, shear, poisson, density, yield, compressive, tensile, expansion, fracture] = material;
    each(name, young, shear, poisson, density, yield, compressive, tensile, expansion, fracture);
  }
  void add(const Section& section) {
    const auto& [name, shape, catalogue, depth, width, web, flange, fillet, thickness, area, Iy, Iz, J, shear_y,
                 shear_z, plastic_y, plastic_z, torsion, plastic_shear_y, plastic_shear_z] = section;
    each(name, shape, catalogue, depth, width, web, flange, fillet, thickness, area, Iy, Iz, J, shear_y, shear_z,
         plastic_y, plastic_z, torsion, plastic_shear_y, plastic_shear_z);
  }
  void add(const Node& node) {
    const auto& [name, position] = node;
    each(name, position);
  }
  void add(const Member& member) {
    const auto& [name, kind, nodes, section, material, offsets, axes, length, axial, design, groups] = member;
    static_cast<void>(design);  // of checks alone
    each(name, kind, nodes, section, material, offsets, axes, length, axial, groups);
  }
  void add(const Panel& panel) {
    const auto& [name, kind, model, nodes, thickness, material, span, mesh, openings, axes, groups, fracture,
                 edge_nodes, joined] = panel;
    each(name, kind, model, nodes, thickness, material, span, mesh, openings, axes, groups, fracture, edge_nodes,
         joined);
  }
  void add(const JointCapacity& capacity) {
    const auto& [value, interaction, ductility, breakable] = capacity;
    each(value, interaction, ductility, breakable);
  }
  void add(const Joint& joint) {
    const auto& [name, member, panel, end, stiffness, capacity] = joint;
    each(name, member, panel, end, stiffness, capacity);
  }
  void add(const NodeSupport& support) {
    const auto& [node, stiffness] = support;
    each(node, stiffness);
  }
  void add(const EdgeSupport& support) {
    const auto& [panel, edge, stiffness] = support;
    each(panel, edge, stiffness);
  }
  void add(const Diaphragm& diaphragm) {
    const auto& [name, nodes] = diaphragm;
    each(name, nodes);
  }
  void add(const MemberLoad& load) {
    const auto& [member, kind, frame, from, to, first, last, temperature, gradient_y, gradient_z] = load;
    each(member, kind, frame, from, to, first, last, temperature, gradient_y, gradient_z);
  }
  void add(const PanelLoad& load) {
    const auto& [panel, pressure, temperature] = load;
    each(panel, pressure, temperature);
  }
  void add(const NodeLoad& load) {
    const auto& [node, value] = load;
    each(node, value);
  }
  void add(const Settlement& settlement) {
    const auto& [node, component, value] = settlement;
    each(node, component, value);
  }
  void add(const LoadCase& one) {
    const auto& [name, self_weight, members, panels, nodes, settlements] = one;
    each(name, self_weight, members, panels, nodes, settlements);
  }
  void add(const Combination& combination) {
    const auto& [name, factors] = combination;
    each(name, factors);
  }
  void add(const NodeMass& node) {
    const auto& [id, mass, inertia] = node;
    each(id, mass, inertia);
  }
  void add(const MassSources& masses) {
    const auto& [nodes, members, loads] = masses;
    each(nodes, members, loads);
  }
  void add(const Building& building) {
    const auto& [title, file, units, gravity, materials, sections, nodes, members, panels, joints, supports,
                 edge_supports, diaphragms, masses, cases, combinations, requested, warnings] = building;
    static_cast<void>(title), static_cast<void>(file), static_cast<void>(units), static_cast<void>(requested),
        static_cast<void>(warnings);
    each(gravity, materials, sections, nodes, members, panels, joints, supports, edge_supports, diaphragms, masses,
         cases, combinations);
  }

  /// The tool as a snapshot holds it.
  void add(const Event& event) {
    const auto& [at, tool] = event;
    each(at, snapshot_bytes({0, 0, 0, {{0, tool}}}));
  }
  void add(const FailureRules& rules) {
    const auto& [bracing, mechanism, second_order, sudden] = rules;
    each(bracing, mechanism, second_order, sudden);
  }
  void add(const MotionRules& rules) {
    const auto& [substeps, damping, spectral_radius] = rules;
    each(substeps, damping, spectral_radius);
  }
  void add(const ImpactRules& rules) {
    const auto& [restitution, structure_mass] = rules;
    each(restitution, structure_mass);
  }
  void add(const DebrisRules& rules) {
    const auto& [friction, restitution, limit, smallest_volume] = rules;
    each(friction, restitution, limit, smallest_volume);
  }
  void add(const Scenario& scenario) {
    const auto& [title, file, model, combination, step, duration, until_rest, seed, ground, standing, motion, failure,
                 impact, debris, fracture, events] = scenario;
    static_cast<void>(title), static_cast<void>(file), static_cast<void>(model), static_cast<void>(duration),
        static_cast<void>(until_rest);  // a run may be taken up to go on longer
    each(combination, step, seed, ground, standing, motion, failure, impact, debris, fracture, events);
  }

  ReplayHash hash_;
};

}  // namespace

std::uint64_t scene_hash(const Building& building, const Scenario& scenario) {
  SceneHash hash;
  hash.each(building, scenario);
  return hash.value();
}

}  // namespace topple::structure
