#include "frame3dd.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "frame3dd_tokens.h"

namespace topple::structure {

namespace {

constexpr int most_parts = 10'000'000;  // of one kind: a count beyond it is a slip of the pen, not a model

constexpr std::array<const char*, 3> force_names{"X", "Y", "Z"};
constexpr std::array<const char*, 6> freedom_names{"x", "y", "z", "xx", "yy", "zz"};

/// One element's line: what sections and materials are made of.
struct ElementData {
  std::array<double, 6> section{};   // Ax Asy Asz Jxx Iyy Izz
  std::array<double, 3> material{};  // E G density
};

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : tokens_(text, name) {
    building_.file = name;
    building_.title = tokens_.title();
    building_.units = Units{1, 1, 1, "consistent", "consistent", "consistent", true};
  }

  Building read() {
    read_nodes();
    read_reactions();
    read_elements();
    read_settings();
    read_load_cases();
    make_materials();
    if (!tokens_.at_end()) read_modes();
    return std::move(building_);
  }

 private:
  void read_nodes() {
    const int count = tokens_.count("the number of nodes", 2, 5);
    std::vector<bool> seen(static_cast<std::size_t>(count), false);
    building_.nodes.resize(seen.size());
    radius_.resize(seen.size());
    for (int k = 0; k < count; ++k) {
      const int n = numbered("node", count, seen);
      Node& node = building_.nodes[static_cast<std::size_t>(n - 1)];
      node.name = std::to_string(n);
      for (std::size_t i = 0; i < 3; ++i)
        node.position[static_cast<int>(i)] = tokens_.number(std::string(freedom_names[i]) + " of node " + node.name);
      radius_[static_cast<std::size_t>(n - 1)] = tokens_.number_from("the radius of node " + node.name, 0);
    }
  }

  void read_reactions() {
    const int count = tokens_.whole("the number of nodes with reactions", 0, node_count());
    std::vector<bool> seen(building_.nodes.size(), false);
    held_.resize(building_.nodes.size());
    for (int k = 0; k < count; ++k) {
      const int n = numbered("node with reactions", node_count(), seen);
      NodeSupport support{NodeId(static_cast<std::size_t>(n - 1)), Vec6::Zero()};
      for (std::size_t i = 0; i < 6; ++i)
        if (tokens_.flag(std::string("reaction ") + freedom_names[i] + " of node " + std::to_string(n))) {
          support.stiffness[static_cast<int>(i)] = unlimited;
          held_[static_cast<std::size_t>(n - 1)][i] = true;
        }
      building_.supports.push_back(support);
    }
  }

  void read_elements() {
    const int count = tokens_.count("the number of frame elements", 1, 12);
    std::vector<bool> seen(static_cast<std::size_t>(count), false);
    building_.members.resize(seen.size());
    elements_.resize(seen.size());
    for (int k = 0; k < count; ++k) read_element(numbered("frame element", count, seen));
    for (std::size_t m = 0; m < building_.members.size(); ++m)
      for (int end = 0; end < 2; ++end) {
        Joint joint;
        joint.name = building_.members[m].name + ":" + std::to_string(end + 1);
        joint.member = MemberId(m);
        joint.end = end;
        building_.joints.push_back(joint);
      }
  }

  void read_element(int number) {
    const std::string name = std::to_string(number);
    Member& member = building_.members[static_cast<std::size_t>(number - 1)];
    ElementData& data = elements_[static_cast<std::size_t>(number - 1)];
    member.name = name;
    for (std::size_t end = 0; end < 2; ++end) {
      const std::string what = "node " + std::to_string(end + 1) + " of element " + name;
      member.nodes[end] = NodeId(static_cast<std::size_t>(tokens_.whole(what, 1, node_count()) - 1));
    }
    constexpr std::array<const char*, 6> properties{"Ax", "Asy", "Asz", "Jxx", "Iyy", "Izz"};
    for (std::size_t i = 0; i < 6; ++i) {
      const std::string what = std::string(properties[i]) + " of element " + name;
      const bool shear_area = i == 1 || i == 2;
      data.section[i] = shear_area ? tokens_.number_from(what, 0) : tokens_.number_above(what, 0);
    }
    data.material[0] = tokens_.number_above("E of element " + name, 0);
    data.material[1] = tokens_.number_above("G of element " + name, 0);
    const double roll = tokens_.number("roll of element " + name) * std::numbers::pi / 180;
    data.material[2] = tokens_.number_from("density of element " + name, 0);
    place(member, roll);
  }

  /// Axes as Frame3DD has them: y horizontal; for a vertical element y = +Y, whichever way it points; then the roll.
  void place(Member& member, double roll) {
    const auto first = static_cast<std::size_t>(member.nodes[0].index);
    const auto second = static_cast<std::size_t>(member.nodes[1].index);
    const Vec3 along = building_.nodes[second].position - building_.nodes[first].position;
    const double distance = along.norm();
    if (!(distance > 0)) tokens_.fail("element " + member.name + " has no length");
    const Vec3 x = along / distance;
    Vec3 y = Vec3::UnitY();
    if (x.x() != 0 || x.y() != 0) y = Vec3(-x.y(), x.x(), 0).normalized();
    const Vec3 z = x.cross(y);
    member.axes.row(0) = x.transpose();
    member.axes.row(1) = (std::cos(roll) * y + std::sin(roll) * z).transpose();
    member.axes.row(2) = (std::cos(roll) * z - std::sin(roll) * y).transpose();
    member.length = distance - radius_[first] - radius_[second];
    if (!(member.length > 0)) tokens_.fail("element " + member.name + " is shorter than the radii of its nodes");
    member.offsets = {Vec3(radius_[first] * x), Vec3(-radius_[second] * x)};
  }

  void read_settings() {
    shear_ = tokens_.flag("the shear deformation flag");
    building_.requested.cubic_p_delta = tokens_.flag("the geometric stiffness flag");
    for (const char* drawing : {"the exaggeration of deformations", "the zoom scale", "the x-axis increment"})
      tokens_.number(drawing);  // how Frame3DD draws: no meaning here
    make_sections();
  }

  void make_sections() {
    std::map<std::array<double, 6>, SectionId> known;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const auto& data = elements_[i].section;
      if (shear_ && !(data[1] > 0 && data[2] > 0))
        tokens_.fail("Asy and Asz of element " + building_.members[i].name +
                     " must be above 0 when the shear deformation flag is 1");
      const auto [found, is_new] = known.try_emplace(data, SectionId(building_.sections.size()));
      if (is_new) building_.sections.push_back(make_section(data));
      building_.members[i].section = found->second;
    }
  }

  [[nodiscard]] Section make_section(const std::array<double, 6>& data) const {
    Section section;
    section.name = "section " + std::to_string(building_.sections.size() + 1);
    section.area = data[0];
    section.shear_area_y = shear_ ? data[1] : 0;
    section.shear_area_z = shear_ ? data[2] : 0;
    section.J = data[3];
    section.Iy = data[4];
    section.Iz = data[5];
    return section;
  }

  void read_load_cases() {
    const int count = tokens_.count("the number of static load cases", 1, 9);
    expansion_.resize(elements_.size());
    for (int k = 1; k <= count; ++k) {
      LoadCase load_case;
      load_case.name = "case " + std::to_string(k);
      read_gravity(load_case);
      read_node_loads(load_case);
      read_uniform_loads(load_case);
      read_trapezoidal_loads(load_case);
      read_point_loads(load_case);
      read_temperature_loads(load_case);
      read_settlements(load_case);
      building_.combinations.push_back({load_case.name, {{LoadCaseId(building_.cases.size()), 1.0}}});
      building_.cases.push_back(std::move(load_case));
    }
    scale_self_weight();
  }

  void read_gravity(LoadCase& load_case) {
    for (std::size_t i = 0; i < 3; ++i)
      load_case.self_weight[static_cast<int>(i)] =
          tokens_.number(std::string("gravity ") + force_names[i] + " of " + load_case.name);
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

  void read_node_loads(LoadCase& load_case) {
    const int count = tokens_.whole("the number of loaded nodes of " + load_case.name, 0, node_count());
    std::vector<bool> seen(building_.nodes.size(), false);
    for (int k = 0; k < count; ++k) {
      const int n = numbered("loaded node", node_count(), seen);
      load_case.nodes.push_back({NodeId(static_cast<std::size_t>(n - 1)), six_numbers("load", n)});
    }
  }

  void read_uniform_loads(LoadCase& load_case) {
    const int count = tokens_.whole("the number of uniform loads of " + load_case.name, 0, most_parts);
    for (int k = 0; k < count; ++k) {
      MemberLoad load = on_element();
      for (std::size_t i = 0; i < 3; ++i)
        load.first[static_cast<int>(i)] = tokens_.number(std::string("uniform load U") + freedom_names[i]);
      load.last = load.first;
      load.to = building_[load.member].length;
      load_case.members.push_back(load);
    }
  }

  void read_trapezoidal_loads(LoadCase& load_case) {
    const int count = tokens_.whole("the number of trapezoidal loads of " + load_case.name, 0, most_parts);
    for (int k = 0; k < count; ++k) {
      const MemberLoad element = on_element();
      for (int i = 0; i < 3; ++i) {
        MemberLoad load = element;
        const std::string axis =
            std::string(" of the trapezoidal load along ") + freedom_names[static_cast<std::size_t>(i)];
        load.from = tokens_.number_from("x1" + axis, 0);
        load.to = tokens_.number_from("x2" + axis, load.from);
        load.first[i] = tokens_.number("w1" + axis);
        load.last[i] = tokens_.number("w2" + axis);
        if (load.first[i] == 0 && load.last[i] == 0) continue;
        load.to = within_element(load.to, load.member);
        if (!(load.to > load.from)) tokens_.fail("x2" + axis + " must be above x1");
        load_case.members.push_back(load);
      }
    }
  }

  void read_point_loads(LoadCase& load_case) {
    const int count = tokens_.whole("the number of internal concentrated loads of " + load_case.name, 0, most_parts);
    for (int k = 0; k < count; ++k) {
      MemberLoad load = on_element();
      load.kind = MemberLoad::Kind::point;
      for (std::size_t i = 0; i < 3; ++i)
        load.first[static_cast<int>(i)] = tokens_.number(std::string("point load P") + freedom_names[i]);
      load.from = within_element(tokens_.number_from("x of the point load", 0), load.member);
      load_case.members.push_back(load);
    }
  }

  void read_temperature_loads(LoadCase& load_case) {
    const int count = tokens_.whole("the number of temperature loads of " + load_case.name, 0, most_parts);
    for (int k = 0; k < count; ++k) {
      MemberLoad load = on_element();
      load.kind = MemberLoad::Kind::temperature;
      const double expansion = tokens_.number("alpha of the temperature load");
      const double depth_y = tokens_.number_above("hy of the temperature load", 0);
      const double depth_z = tokens_.number_above("hz of the temperature load", 0);
      const double y_plus = tokens_.number("Ty+"), y_minus = tokens_.number("Ty-");
      const double z_plus = tokens_.number("Tz+"), z_minus = tokens_.number("Tz-");
      // A material has one coefficient: the first that is not zero counts for the element, and where another load on it
      // has a different one, its temperatures are scaled so that the strains stay what the file says.
      auto& known = expansion_[static_cast<std::size_t>(load.member.index)];
      if (!known && expansion != 0) known = expansion;
      const double scale = expansion == 0 ? 0 : expansion / *known;
      load.temperature = scale * (y_plus + y_minus + z_plus + z_minus) / 4;
      load.gradient_y = scale * (y_plus - y_minus) / depth_y;
      load.gradient_z = scale * (z_plus - z_minus) / depth_z;
      if (expansion != 0) load_case.members.push_back(load);
    }
  }

  void read_settlements(LoadCase& load_case) {
    const int count =
        tokens_.whole("the number of nodes with prescribed displacements of " + load_case.name, 0, node_count());
    std::vector<bool> seen(building_.nodes.size(), false);
    for (int k = 0; k < count; ++k) {
      const int n = numbered("node with prescribed displacements", node_count(), seen);
      const Vec6 values = six_numbers("displacement", n);
      for (int i = 0; i < 6; ++i) {
        if (values[i] == 0) continue;
        if (!held_[static_cast<std::size_t>(n - 1)][static_cast<std::size_t>(i)])
          tokens_.fail("displacement " + std::string(freedom_names[static_cast<std::size_t>(i)]) + " of node " +
                       std::to_string(n) + " is prescribed where the node has no reaction");
        load_case.settlements.push_back({NodeId(static_cast<std::size_t>(n - 1)), i, values[i]});
      }
    }
  }

  void make_materials() {
    std::map<std::array<double, 5>, MaterialId> known;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const auto& data = elements_[i].material;
      const std::array<double, 5> key{data[0], data[1], data[2], expansion_[i].value_or(0), expansion_[i] ? 1.0 : 0.0};
      const auto [found, is_new] = known.try_emplace(key, MaterialId(building_.materials.size()));
      if (is_new) {
        Material material;
        material.name = "material " + std::to_string(building_.materials.size() + 1);
        material.youngs_modulus = data[0];
        material.shear_modulus = data[1];
        material.poisson_ratio = data[0] / (2 * data[1]) - 1;
        material.density = data[2];
        material.thermal_expansion = expansion_[i];
        building_.materials.push_back(material);
      }
      building_.members[i].material = found->second;
    }
  }

  void read_modes() {
    RequestedAnalyses& requested = building_.requested;
    requested.modes = tokens_.whole("the number of dynamic modes", 0, most_parts);
    if (requested.modes == 0) return;
    requested.modes_of_last_combination = requested.cubic_p_delta;
    tokens_.whole("the eigenvalue method", 1, 2);
    requested.lumped_mass = tokens_.flag("the lumped mass flag");
    tokens_.number_above("the mode shape tolerance", 0);
    requested.frequency_shift = tokens_.number("the shift");
    tokens_.number("the exaggeration of modes");
    read_extra_masses();
    if (tokens_.at_end()) return;
    const int animated = tokens_.whole("the number of modes to animate", 0, most_parts);
    for (int k = 0; k < animated; ++k) tokens_.whole("a mode to animate", 1, most_parts);
    if (!tokens_.at_end()) tokens_.number("the pan rate");
    if (!tokens_.at_end()) read_condensation();
  }

  void read_extra_masses() {
    const int nodes = tokens_.whole("the number of nodes with extra inertia", 0, node_count());
    std::vector<bool> seen(building_.nodes.size(), false);
    for (int k = 0; k < nodes; ++k) {
      const int n = numbered("node with extra inertia", node_count(), seen);
      const std::string of = " of node " + std::to_string(n);
      NodeMass mass;
      mass.node = NodeId(static_cast<std::size_t>(n - 1));
      mass.mass = tokens_.number_from("the extra mass" + of, 0);
      for (std::size_t i = 0; i < 3; ++i)
        mass.inertia[static_cast<int>(i)] =
            tokens_.number_from(std::string("the inertia I") + freedom_names[3 + i] + of, 0);
      building_.masses.nodes.push_back(mass);
    }
    const int elements = tokens_.whole("the number of elements with extra mass", 0, element_count());
    std::vector<bool> seen_element(elements_.size(), false);
    for (int k = 0; k < elements; ++k) {
      const int e = numbered("element with extra mass", element_count(), seen_element);
      const double mass = tokens_.number_from("the extra mass of element " + std::to_string(e), 0);
      building_.masses.members.emplace_back(MemberId(static_cast<std::size_t>(e - 1)), mass);
    }
  }

  /// Matrix condensation changes no result: it is read, checked and told.
  void read_condensation() {
    const int method = tokens_.whole("the condensation method", 0, 3);
    if (method == 0) return;
    const int nodes = tokens_.whole("the number of condensed nodes", 0, node_count());
    std::vector<bool> seen(building_.nodes.size(), false);
    int condensed = 0;
    for (int k = 0; k < nodes; ++k) {
      const int n = numbered("condensed node", node_count(), seen);
      for (const char* freedom : freedom_names)
        condensed += tokens_.flag(std::string("the condensation flag ") + freedom + " of node " + std::to_string(n));
    }
    for (int k = 0; k < condensed && !tokens_.at_end(); ++k) tokens_.whole("a mode to match", 0, most_parts);
    building_.warnings.push_back(
        "the file asks for matrix condensation, which is not carried out (no result depends on it)");
  }

  /// Reads the number of a part, 1 to count, each once.
  int numbered(const std::string& part, int count, std::vector<bool>& seen) {
    const int n = tokens_.whole("the number of a " + part, 1, count);
    if (seen[static_cast<std::size_t>(n - 1)]) tokens_.fail(part + " " + std::to_string(n) + " is given twice");
    seen[static_cast<std::size_t>(n - 1)] = true;
    return n;
  }

  Vec6 six_numbers(const std::string& kind, int node) {
    Vec6 values;
    for (std::size_t i = 0; i < 6; ++i)
      values[static_cast<int>(i)] = tokens_.number(kind + " " + freedom_names[i] + " of node " + std::to_string(node));
    return values;
  }

  MemberLoad on_element() {
    MemberLoad load;
    load.frame = LoadFrame::local;
    const int e = tokens_.whole("the number of a loaded element", 1, element_count());
    load.member = MemberId(static_cast<std::size_t>(e - 1));
    return load;
  }

  /// A place may pass the element's end by the rounding of printed coordinates, not by more.
  [[nodiscard]] double within_element(double place, MemberId element) const {
    constexpr double rounding = 1e-6;
    const double length = building_[element].length;
    if (place > length * (1 + rounding))
      tokens_.fail("a load lies beyond the end of element " + building_[element].name + ", whose length is " +
                   std::to_string(length));
    return std::min(place, length);
  }

  [[nodiscard]] int node_count() const { return static_cast<int>(building_.nodes.size()); }
  [[nodiscard]] int element_count() const { return static_cast<int>(elements_.size()); }

  Frame3ddTokens tokens_;
  Building building_;
  std::vector<double> radius_;
  std::vector<std::array<bool, 6>> held_;
  std::vector<ElementData> elements_;
  std::vector<std::optional<double>> expansion_;
  bool shear_ = false;
};

}  // namespace

Building parse_frame3dd(std::string_view text, const std::string& name) { return Reader(text, name).read(); }

}  // namespace topple::structure
