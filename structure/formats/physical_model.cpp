#include "formats/physical_model.h"

#include <string>

#include "topple/structure/number_range.h"

namespace topple::structure::formats {

namespace {

constexpr NumberRange density{1e-12, 1e6};     // kg/m3; t/mm3 where a model counts in these
constexpr NumberRange area{1e-9, 1e6};         // m2; mm2
constexpr NumberRange inertia{1e-18, 1e12};    // m4; mm4
constexpr NumberRange thickness{1e-4, 1e5};    // m; mm
constexpr NumberRange capacity{1e-6, 1e18};    // N, N m, N/m
constexpr NumberRange stiffness{1e-12, 1e30};  // N/m, N m/rad

class Physical {
 public:
  explicit Physical(const Building& building) : building_(building) {}

  void require() const {
    require_in(ranges::gravity, building_.gravity, of("gravity"));
    for (const Material& material : building_.materials) require(material);
    for (const Section& section : building_.sections) require(section);
    for (const Node& node : building_.nodes)
      for (const double coordinate : node.position) require_in(ranges::place, coordinate, of("nodes." + node.name));
    for (const Member& member : building_.members)
      require_in(ranges::length, member.length, of("members." + member.name + ": its length"));
    for (const Panel& panel : building_.panels)
      require_in(thickness, panel.thickness, of("panels." + panel.name + ".thickness"));
    for (const Joint& joint : building_.joints) require(joint);
    for (const LoadCase& one : building_.cases) require(one);
    for (const NodeMass& mass : building_.masses.nodes)
      require_in({0, 1e12}, mass.mass, of("masses of node " + building_[mass.node].name));
  }

 private:
  [[nodiscard]] std::string of(const std::string& thing) const { return building_.file + ", " + thing; }

  void require(const Material& material) const {
    const std::string name = of("materials." + material.name);
    if (material.density != 0) require_in(density, material.density, name + ".density");
    require_in(ranges::modulus, material.youngs_modulus, name + ".youngs_modulus");
    require_in(ranges::modulus, material.shear_modulus, name + ".shear_modulus");
  }
  void require(const Section& section) const {
    const std::string name = of("sections." + section.name);
    require_in(area, section.area, name + ": its area");
    for (const double property : {section.Iy, section.Iz, section.J})
      require_in(inertia, property, name + ": its second moment of area or J");
  }
  void require(const Joint& joint) const {
    const std::string name = of("joint " + joint.name);
    for (const double value : joint.capacity.value)
      if (value != unlimited) require_in(capacity, value, name + ": its capacity");
    for (const double value : joint.stiffness)
      if (value != 0 && value != unlimited) require_in(stiffness, value, name + ": its stiffness");
  }
  void require(const LoadCase& one) const {
    const std::string name = of("loads." + one.name);
    require_in({-1e6, 1e6}, one.self_weight.lpNorm<Eigen::Infinity>(), name + ".self_weight");
    for (const MemberLoad& load : one.members) {
      const std::string place = name + ".members." + building_[load.member].name;
      require_in(ranges::force, load.first.lpNorm<Eigen::Infinity>(), place);
      require_in(ranges::force, load.last.lpNorm<Eigen::Infinity>(), place);
    }
    for (const PanelLoad& load : one.panels)
      require_in(ranges::force, load.pressure, name + ".panels." + building_[load.panel].name);
    for (const NodeLoad& load : one.nodes)
      require_in(ranges::force, load.load.lpNorm<Eigen::Infinity>(), name + ".nodes." + building_[load.node].name);
  }

  const Building& building_;
};

}  // namespace

void require_physical(const Building& building) { Physical(building).require(); }

}  // namespace topple::structure::formats
