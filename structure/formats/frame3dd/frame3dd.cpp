// From the numbers of a .3dd file to a building.
#include "formats/frame3dd/frame3dd.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "formats/frame3dd/frame3dd_file.h"

namespace topple::structure {

namespace {

class Builder {
 public:
  Builder(const Frame3ddFile& file, const std::string& name) : file_(file) {
    building_.file = name;
    building_.title = file.title;
    building_.units = Units{1, 1, 1, "consistent", "consistent", "consistent", true};
  }

  Building build() {
    add_nodes();
    add_supports();
    add_members();
    add_sections();
    building_.requested.cubic_p_delta = file_.geometric_stiffness;
    add_load_cases();
    add_materials();
    if (file_.modes) add_modes(*file_.modes);
    warn_of_radii();
    return std::move(building_);
  }

 private:
  static std::string numbered(std::size_t index) { return std::to_string(index + 1); }
  static NodeId node_id(int index) { return NodeId(static_cast<std::size_t>(index)); }
  static MemberId member_id(int index) { return MemberId(static_cast<std::size_t>(index)); }

  void add_nodes() {
    for (std::size_t i = 0; i < file_.nodes.size(); ++i) building_.nodes.push_back({numbered(i), file_.nodes[i].place});
  }

  void add_supports() {
    for (const Frame3ddFile::Reaction& reaction : file_.reactions) {
      NodeSupport support{node_id(reaction.node), Vec6::Zero()};
      for (std::size_t i = 0; i < 6; ++i)
        if (reaction.held[i]) support.stiffness[static_cast<int>(i)] = unlimited;
      building_.supports.push_back(support);
    }
  }

  void add_members() {
    for (std::size_t i = 0; i < file_.elements.size(); ++i) {
      const Frame3ddFile::Element& element = file_.elements[i];
      const Frame3ddFile::Node& first = file_.nodes[static_cast<std::size_t>(element.nodes[0])];
      const Frame3ddFile::Node& second = file_.nodes[static_cast<std::size_t>(element.nodes[1])];
      Member member;
      member.name = numbered(i);
      member.nodes = {node_id(element.nodes[0]), node_id(element.nodes[1])};
      const Vec3 along = second.place - first.place;
      member.axes = frame3dd_axes(along, element.roll);
      // As there, a radius makes the element shorter without an arm between its end and the node.
      member.length = along.norm() - first.radius - second.radius;
      stretch_.push_back(along.norm() / member.length);
      building_.members.push_back(std::move(member));
    }
    for (std::size_t m = 0; m < building_.members.size(); ++m)
      for (int end = 0; end < 2; ++end) {
        Joint joint;
        joint.name = building_.members[m].name + ":" + std::to_string(end + 1);
        joint.member = MemberId(m);
        joint.end = end;
        building_.joints.push_back(joint);
      }
  }

  void add_sections() {
    std::map<std::array<double, 6>, SectionId> known;
    for (std::size_t i = 0; i < file_.elements.size(); ++i) {
      const auto& data = file_.elements[i].section;
      const auto [found, is_new] = known.try_emplace(data, SectionId(building_.sections.size()));
      if (is_new) building_.sections.push_back(make_section(data));
      building_.members[i].section = found->second;
    }
  }

  [[nodiscard]] Section make_section(const std::array<double, 6>& data) const {
    Section section;
    section.name = "section " + numbered(building_.sections.size());
    section.area = data[0];
    section.shear_area_y = file_.shear_deformation ? data[1] : 0;
    section.shear_area_z = file_.shear_deformation ? data[2] : 0;
    section.J = data[3];
    section.Iy = data[4];
    section.Iz = data[5];
    return section;
  }

  void add_load_cases() {
    expansion_.resize(file_.elements.size());
    for (const Frame3ddFile::LoadCase& given : file_.cases) {
      LoadCase load_case;
      load_case.name = "case " + numbered(building_.cases.size());
      load_case.self_weight = given.gravity;
      for (const auto& load : given.nodes) load_case.nodes.push_back({node_id(load.node), load.values});
      add_moments_of_weight(given.gravity, load_case);
      add_uniform_loads(given, load_case);
      add_trapezoidal_loads(given, load_case);
      add_point_loads(given, load_case);
      add_temperature_loads(given, load_case);
      for (const auto& moved : given.displacements)
        for (int i = 0; i < 6; ++i)
          if (moved.values[i] != 0) load_case.settlements.push_back({node_id(moved.node), i, moved.values[i]});
      building_.combinations.push_back({load_case.name, {{LoadCaseId(building_.cases.size()), 1.0}}});
      building_.cases.push_back(std::move(load_case));
    }
    scale_self_weight();
  }

  /// Weight acts over the whole distance L between the nodes: what its end moments q L2/12 are more than those of the
  /// same weight on the shorter element, as moments on its very ends.
  void add_moments_of_weight(const Vec3& gravity, LoadCase& load_case) const {
    if (gravity.isZero(0)) return;
    for (std::size_t i = 0; i < file_.elements.size(); ++i) {
      if (stretch_[i] == 1) continue;
      const Frame3ddFile::Element& element = file_.elements[i];
      const Member& member = building_.members[i];
      const double whole = member.length * stretch_[i];
      const Vec3 local = member.axes * gravity;
      const Vec3 moment =
          element.density * element.section[0] * whole * (whole - member.length) / 12 * Vec3::UnitX().cross(local);
      if (moment.isZero(0)) continue;
      for (const bool second : {false, true}) {
        MemberLoad load = on_element(static_cast<int>(i));
        load.kind = MemberLoad::Kind::point;
        load.from = second ? member.length : 0;
        load.first.tail<3>() = second ? Vec3(-moment) : moment;
        load_case.members.push_back(load);
      }
    }
  }

  /// So far self_weight is an acceleration; the building's gravity is the first one found, the cases are multiples of
  /// it.
  void scale_self_weight() {
    building_.gravity = 1;
    for (const LoadCase& load_case : building_.cases)
      if (const double size = load_case.self_weight.norm(); size > 0) {
        building_.gravity = size;
        break;
      }
    for (LoadCase& load_case : building_.cases) load_case.self_weight /= building_.gravity;
  }

  [[nodiscard]] MemberLoad on_element(int element) const {
    MemberLoad load;
    load.frame = LoadFrame::local;
    load.member = member_id(element);
    return load;
  }

  void add_uniform_loads(const Frame3ddFile::LoadCase& given, LoadCase& load_case) const {
    for (const auto& uniform : given.uniform) {
      MemberLoad load = on_element(uniform.element);
      load.first.head<3>() = uniform.load;
      load.last = load.first;
      load.to = building_[load.member].length;
      load_case.members.push_back(load);
    }
  }

  void add_trapezoidal_loads(const Frame3ddFile::LoadCase& given, LoadCase& load_case) const {
    for (const auto& trapezoid : given.trapezoids)
      for (int i = 0; i < 3; ++i) {
        const auto& [x1, x2, w1, w2] = trapezoid.axes[static_cast<std::size_t>(i)];
        if (w1 == 0 && w2 == 0) continue;
        MemberLoad load = on_element(trapezoid.element);
        load.from = x1;
        load.to = std::min(x2, building_[load.member].length);
        load.first[i] = w1;
        load.last[i] = w2;
        load_case.members.push_back(load);
      }
  }

  void add_point_loads(const Frame3ddFile::LoadCase& given, LoadCase& load_case) const {
    for (const auto& point : given.points) {
      MemberLoad load = on_element(point.element);
      load.kind = MemberLoad::Kind::point;
      load.first.head<3>() = point.load;
      load.from = std::min(point.place, building_[load.member].length);
      load_case.members.push_back(load);
    }
  }

  void add_temperature_loads(const Frame3ddFile::LoadCase& given, LoadCase& load_case) {
    for (const auto& heat : given.temperatures) {
      if (heat.expansion == 0) continue;
      // A material has one coefficient: the first that is not zero counts for the element, and where another load on it
      // has a different one, its temperatures are scaled so that the strains stay what the file says.
      auto& known = expansion_[static_cast<std::size_t>(heat.element)];
      if (!known) known = heat.expansion;
      const double scale = heat.expansion / *known;
      const auto& [y, z] = heat.faces;
      MemberLoad load = on_element(heat.element);
      load.kind = MemberLoad::Kind::temperature;
      load.temperature = scale * (y[0] + y[1] + z[0] + z[1]) / 4;
      load.gradient_y = scale * (y[0] - y[1]) / heat.depth[0];
      load.gradient_z = scale * (z[0] - z[1]) / heat.depth[1];
      load_case.members.push_back(load);
    }
  }

  void add_materials() {
    std::map<std::array<double, 5>, MaterialId> known;
    for (std::size_t i = 0; i < file_.elements.size(); ++i) {
      const Frame3ddFile::Element& element = file_.elements[i];
      const double density = element.density * stretch_[i];  // the whole element's mass on what is left of it
      const std::array<double, 5> key{element.E, element.G, density, expansion_[i].value_or(0),
                                      expansion_[i] ? 1.0 : 0.0};
      const auto [found, is_new] = known.try_emplace(key, MaterialId(building_.materials.size()));
      if (is_new) {
        Material material;
        material.name = "material " + numbered(building_.materials.size());
        material.youngs_modulus = element.E;
        material.shear_modulus = element.G;
        material.poisson_ratio = element.E / (2 * element.G) - 1;
        material.density = density;
        material.thermal_expansion = expansion_[i];
        building_.materials.push_back(material);
      }
      building_.members[i].material = found->second;
    }
  }

  void warn_of_radii() {
    if (std::any_of(file_.nodes.begin(), file_.nodes.end(), [](const auto& node) { return node.radius > 0; }))
      building_.warnings.push_back(frame3dd_radius_warning);
  }

  void add_modes(const Frame3ddFile::Modes& modes) {
    RequestedAnalyses& requested = building_.requested;
    requested.modes = modes.count;
    if (modes.count == 0) return;
    requested.modes_of_last_combination = file_.geometric_stiffness;
    requested.lumped_mass = modes.lumped;
    requested.frequency_shift = modes.shift;
    for (const auto& extra : modes.nodes)
      building_.masses.nodes.push_back({node_id(extra.node), extra.mass, extra.inertia});
    for (const auto& [element, mass] : modes.elements) building_.masses.members.emplace_back(member_id(element), mass);
    if (modes.condensation && modes.condensation->method != 0)
      building_.warnings.push_back(frame3dd_condensation_warning);
  }

  const Frame3ddFile& file_;
  Building building_;
  std::vector<std::optional<double>> expansion_;
  std::vector<double> stretch_;  ///< of each element: distance of its nodes over its length
};

}  // namespace

Mat3 frame3dd_axes(const Vec3& along, double roll_degrees) {
  const double roll = roll_degrees * std::numbers::pi / 180;
  const Vec3 x = along / along.norm();
  Vec3 y = Vec3::UnitY();
  if (x.x() != 0 || x.y() != 0) y = Vec3(-x.y(), x.x(), 0).stableNormalized();
  const Vec3 z = x.cross(y);
  Mat3 axes;
  axes.row(0) = x.transpose();
  axes.row(1) = (std::cos(roll) * y + std::sin(roll) * z).transpose();
  axes.row(2) = (std::cos(roll) * z - std::sin(roll) * y).transpose();
  return axes;
}

Building parse_frame3dd(std::string_view text, const std::string& name) {
  return Builder(parse_frame3dd_file(text, name), name).build();
}

}  // namespace topple::structure
