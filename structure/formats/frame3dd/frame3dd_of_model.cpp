// A JSON model as a .3dd file. What such a file cannot hold is refused by its name; numbers go over as they stand.
#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <unordered_map>

#include "formats/frame3dd/frame3dd_of_model.h"
#include "formats/geometry.h"
#include "formats/model_forms.h"
#include "formats/model_reader.h"

namespace topple::structure {

namespace {

using formats::JsonDocument;
using formats::JsonValue;

using frame3dd_model::hold_only;
using frame3dd_model::number_or;
using frame3dd_model::refuse;

Vec3 three(const JsonValue& value) { return formats::read_point(value, 1); }

/// The number with the fewest digits among those near `value` for which `same` holds; none: no value.
template <class Same>
std::optional<double> shortest(double value, Same same) {
  for (int digits = 1; digits <= 17; ++digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
    double candidate = 0;
    std::from_chars(text, text + std::char_traits<char>::length(text), candidate);
    if (same(candidate)) return candidate;
  }
  for (const double towards : {-HUGE_VAL, HUGE_VAL})
    if (const double neighbour = std::nextafter(value, towards); same(neighbour)) return neighbour;
  return std::nullopt;
}

class FileMaker {
 public:
  FileMaker(const JsonDocument& model, const Building& building) : root_(model.root()), building_(building) {}

  Frame3ddFile make() {
    hold_only(root_,
              {"topple", "title", "units", "gravity", "materials", "sections", "joints", "nodes", "members", "panels",
               "supports", "masses", "loads", "combinations", "analyses", "frame3dd"},
              "nodes, members, supports, loads on them, masses");
    if (const auto panels = root_.find("panels"))
      for (const JsonValue panel : *panels) refuse(panel, "members only");
    title();
    check_units();
    gravity_ = number_or(root_, "gravity", building_.gravity / building_.units.length);
    nodes();
    members();
    supports();
    settings();
    loads();
    modes();
    return std::move(file_);
  }

 private:
  void title() {
    const auto title = root_.find("title");
    if (!title) return;
    file_.title = title->text();
    if (file_.title.find_first_of("\n\r") != std::string::npos) refuse(*title, "one line");
  }

  /// A .3dd file names no units: those of the model must go together by themselves (force = mass x length / s2).
  void check_units() const {
    const Units& units = building_.units;
    constexpr double rounding = 1e-12;
    if (std::abs(units.force - units.mass * units.length) <= rounding * units.force) return;
    refuse(root_.require("units"), "\"consistent\", or units that go together, such as m, N, kg; m, kN, t; mm, N, t");
  }

  /// Numbers of parts: their names where these are 1 to n in any order, else their order in the file.
  static std::unordered_map<std::string, int> numbers_of(const JsonValue& parts) {
    std::unordered_map<std::string, int> numbers;
    const int count = static_cast<int>(parts.size());
    std::vector<bool> seen(parts.size(), false);
    bool by_name = true;
    for (const JsonValue part : parts) {
      const std::string_view name = part.key();
      int number = 0;
      const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), number);
      by_name = by_name && error == std::errc() && stop == name.data() + name.size() && number >= 1 &&
                number <= count && name.front() != '0' && !seen[static_cast<std::size_t>(number - 1)];
      if (!by_name) break;
      seen[static_cast<std::size_t>(number - 1)] = true;
      numbers.emplace(name, number - 1);
    }
    if (by_name) return numbers;
    numbers.clear();
    for (const JsonValue part : parts) numbers.emplace(part.key(), static_cast<int>(numbers.size()));
    return numbers;
  }
  static std::string remark(const JsonValue& part, int index) {
    return part.key() == std::to_string(index + 1) ? std::string() : std::string(part.key());
  }
  [[nodiscard]] int node_of(const std::string_view name) const { return node_numbers_.at(std::string(name)); }

  void nodes() {
    const JsonValue nodes = root_.require("nodes");
    node_numbers_ = numbers_of(nodes);
    file_.nodes.resize(nodes.size());
    for (const JsonValue value : nodes) {
      const int n = node_of(value.key());
      Frame3ddFile::Node& node = file_.nodes[static_cast<std::size_t>(n)];
      node.place = three(value);
      node.remark = remark(value, n);
    }
    radius_given_.resize(nodes.size(), false);
  }

  void members() {
    const JsonValue members = root_.require("members");
    member_numbers_ = numbers_of(members);
    file_.elements.resize(members.size());
    materials_.resize(members.size());
    axes_.resize(members.size());
    std::size_t position = 0;
    for (const JsonValue value : members) member(value, building_.members[position++]);
    // Radii are of nodes: every element at a node must have the same.
    for (const JsonValue value : members) {
      const auto& element = file_.elements[static_cast<std::size_t>(member_numbers_.at(std::string(value.key())))];
      const auto offsets = value.find("offsets");
      for (const int node : element.nodes)
        if (!offsets && file_.nodes[static_cast<std::size_t>(node)].radius > 0)
          value.fail(
              "it has no `offsets`, but another member at one of its nodes has; accepted in a .3dd file: one "
              "rigid radius for all members at a node");
    }
  }

  /// Kind and groups go into the comment beside the element: they change no result.
  void member(const JsonValue& value, const Member& known) {
    hold_only(value, {"kind", "nodes", "section", "material", "up", "roll", "joints", "offsets", "axial", "groups"},
              "nodes, section, material, up, roll");
    const int index = member_numbers_.at(std::string(value.key()));
    Frame3ddFile::Element& element = file_.elements[static_cast<std::size_t>(index)];
    element.remark = remark(value, index);
    if (const auto groups = value.find("groups"))
      for (const JsonValue group : *groups)
        element.remark += (element.remark.empty() ? "" : " ") + std::string(group.text());
    axes_[static_cast<std::size_t>(index)] = known.axes;
    std::size_t end = 0;
    for (const JsonValue node : value.require("nodes")) element.nodes[end++] = node_of(node.text());
    if (const auto axial = value.find("axial"); axial && axial->text() != "both") refuse(*axial, "\"both\"");
    if (const auto joints = value.find("joints"); joints && joints->is_array())
      for (const JsonValue joint : *joints)
        if (!joint.is_null()) refuse(joint, "null");
    section(value, known, element);
    material(value, element, index);
    roll(value, element);
    offsets(value, element);
  }

  void section(const JsonValue& value, const Member& member, Frame3ddFile::Element& element) {
    const JsonValue section = root_.require("sections").require(value.require("section").text());
    const bool by_shape = section.find("shape") || section.find("catalogue");
    by_shape ? shaped_section(building_[member.section], element) : numbered_section(section, element);
    const auto deforms = section.find("shear_deformation");
    const bool areas = element.section[1] > 0 || element.section[2] > 0;
    const bool shear = areas && (!deforms || deforms->boolean());
    if (shear && !(element.section[1] > 0 && element.section[2] > 0))
      refuse(section, "both shear areas above 0, or none");
    if (!shear_) shear_ = shear;
    if (*shear_ != shear) refuse(section, "shear deformation in all sections, or in none");
  }

  static void numbered_section(const JsonValue& section, Frame3ddFile::Element& element) {
    hold_only(section, {"area", "Iy", "Iz", "J", "shear_area_y", "shear_area_z", "shear_deformation"},
              "a section as numbers: area, shear_area_y, shear_area_z, J, Iy, Iz; or one by shape");
    constexpr std::array<const char*, 6> keys{"area", "shear_area_y", "shear_area_z", "J", "Iy", "Iz"};
    for (std::size_t k = 0; k < keys.size(); ++k) element.section[k] = number_or(section, keys[k], 0);
  }

  /// What the shape or the catalogue says, in the units of the file.
  void shaped_section(const Section& section, Frame3ddFile::Element& element) const {
    const double length = building_.units.length, area = length * length, inertia = area * area;
    element.section = {section.area / area, section.shear_area_y / area, section.shear_area_z / area,
                       section.J / inertia, section.Iy / inertia,        section.Iz / inertia};
  }

  void material(const JsonValue& value, Frame3ddFile::Element& element, int index) {
    const JsonValue material = root_.require("materials").require(value.require("material").text());
    hold_only(material, {"youngs_modulus", "shear_modulus", "poisson_ratio", "density", "thermal_expansion"},
              "youngs_modulus, shear_modulus or poisson_ratio, density, thermal_expansion");
    const auto shear = material.find("shear_modulus"), poisson = material.find("poisson_ratio");
    if (shear && poisson) refuse(*poisson, "shear_modulus alone");
    element.E = material.require("youngs_modulus").number();
    element.G = shear ? shear->number() : element.E / (2 * (1 + poisson->number()));
    element.density = number_or(material, "density", 0);
    materials_[static_cast<std::size_t>(index)] = number_or(material, "thermal_expansion", 0);
  }

  /// Degrees that turn Frame3DD's axes to those of the member. Where `up` is Frame3DD's own the roll alone counts, and
  /// it must come back to its bits.
  void roll(const JsonValue& value, Frame3ddFile::Element& element) {
    const Vec3 along = file_.nodes[static_cast<std::size_t>(element.nodes[1])].place -
                       file_.nodes[static_cast<std::size_t>(element.nodes[0])].place;
    const auto given = value.find("roll"), up = value.find("up");
    const double radians = given ? given->number() : 0;
    const Mat3 unrolled = frame3dd_axes(along, 0);
    const auto axes = formats::member_axes(along, up ? std::optional<Vec3>(three(*up)) : std::nullopt, 0);
    const Vec3 y = axes->row(1).transpose();
    const double between = std::atan2(y.dot(unrolled.row(2).transpose()), y.dot(unrolled.row(1).transpose()));
    constexpr double rounding = 1e-12;
    const double degrees = (radians + (std::abs(between) < rounding ? 0 : between)) * 180 / std::numbers::pi;
    if (std::abs(between) < rounding) {
      const auto exact = shortest(degrees, [&](double d) { return d * std::numbers::pi / 180 == radians; });
      if (!exact) refuse(*given, "an angle that is a number of degrees to the bit");
      element.roll = *exact;
      return;
    }
    const auto near = shortest(degrees, [&](double d) {
      return (frame3dd_axes(along, d) - frame3dd_axes(along, degrees)).cwiseAbs().maxCoeff() < rounding;
    });
    element.roll = near.value_or(degrees);
  }

  /// Arms along the member become the radii of its nodes.
  void offsets(const JsonValue& value, const Frame3ddFile::Element& element) {
    const auto given = value.find("offsets");
    if (!given) return;
    // A radius is no arm to Frame3DD: only what came from such a file goes back into one.
    if (!root_.find("frame3dd")) refuse(*given, "members without rigid arms");
    const Vec3 along = file_.nodes[static_cast<std::size_t>(element.nodes[1])].place -
                       file_.nodes[static_cast<std::size_t>(element.nodes[0])].place;
    const Vec3 x = along / along.norm();
    std::size_t end = 0;
    for (const JsonValue arm : *given) {
      const double sign = end == 0 ? 1 : -1;
      const Vec3 offset = three(arm);
      const auto radius = shortest(offset.norm(), [&](double r) { return Vec3(sign * r * x) == offset; });
      const std::string accepted = "arms along the member, of one length at each node";
      if (!radius) refuse(arm, accepted);
      const auto node = static_cast<std::size_t>(element.nodes[end++]);
      if (radius_given_[node] && file_.nodes[node].radius != *radius) refuse(arm, accepted);
      file_.nodes[node].radius = *radius;
      radius_given_[node] = true;
    }
  }

  void supports() {
    held_.resize(file_.nodes.size());
    const auto supports = root_.find("supports");
    if (!supports) return;
    for (const JsonValue value : *supports) {
      const auto found = node_numbers_.find(std::string(value.key()));
      if (found == node_numbers_.end()) refuse(value, "supports of nodes");
      Frame3ddFile::Reaction reaction;
      reaction.node = found->second;
      const Vec6 stiffness = formats::read_support(value, {});
      for (int i = 0; i < 6; ++i) {
        if (stiffness[i] != 0 && stiffness[i] != unlimited) refuse(value, "components that are free or held");
        reaction.held[static_cast<std::size_t>(i)] = stiffness[i] == unlimited;
      }
      held_[static_cast<std::size_t>(reaction.node)] = reaction.held;
      file_.reactions.push_back(reaction);
    }
  }

  void settings() {
    file_.shear_deformation = shear_.value_or(false);
    if (const auto analyses = root_.find("analyses"))
      if (const auto p_delta = analyses->find("p_delta")) file_.geometric_stiffness = p_delta->text() == "cubic";
    if (const auto own = root_.find("frame3dd")) {
      file_.exaggeration = number_or(*own, "exaggeration", file_.exaggeration);
      file_.zoom = number_or(*own, "zoom", file_.zoom);
      file_.increment = number_or(*own, "increment", file_.increment);
    }
  }

  // Loads.

  void loads() {
    const Frame3ddNumbers numbers{node_numbers_, member_numbers_, axes_, materials_, gravity_};
    frame3dd_load_cases(root_, numbers, file_);
  }

  void modes() {
    const auto analyses = root_.find("analyses"), own = root_.find("frame3dd"), masses = root_.find("masses");
    const auto count = analyses ? analyses->find("modes") : std::nullopt;
    if (!count && !(own && own->find("method"))) {
      if (masses) refuse(*masses, "masses beside `modes` in `analyses`");
      return;
    }
    Frame3ddFile::Modes& modes = file_.modes.emplace();
    if (own) own_of_modes(*own, modes);
    if (!count) {
      if (masses) refuse(*masses, "masses beside `modes` in `analyses`");
      return;
    }
    modes.count = static_cast<int>(count->whole(0, 10'000'000));
    if (const auto mass = analyses->find("mass")) modes.lumped = mass->text() == "lumped";
    modes.shift = number_or(*analyses, "shift", 0);
    if (masses) extra_masses(*masses, modes);
  }

  void own_of_modes(const JsonValue& own, Frame3ddFile::Modes& modes) {
    if (const auto method = own.find("method")) modes.method = static_cast<int>(method->whole(1, 2));
    modes.tolerance = number_or(own, "tolerance", modes.tolerance);
    modes.exaggeration = number_or(own, "mode_exaggeration", modes.exaggeration);
    if (const auto animated = own.find("animated")) {
      modes.animated.emplace();
      for (const JsonValue mode : *animated) modes.animated->push_back(static_cast<int>(mode.whole(1, 10'000'000)));
    }
    if (const auto pan = own.find("pan")) modes.pan = pan->number();
    if (const auto condensation = own.find("condensation")) this->condensation(*condensation, modes);
  }

  void condensation(const JsonValue& value, Frame3ddFile::Modes& modes) {
    Frame3ddFile::Condensation& condensation = modes.condensation.emplace();
    condensation.method = static_cast<int>(value.require("method").whole(0, 3));
    if (const auto nodes = value.find("nodes"))
      for (const JsonValue flags : *nodes) {
        auto& node = condensation.nodes.emplace_back();
        node.node = node_of(flags.key());
        std::size_t i = 0;
        for (const JsonValue flag : flags) node.flags[i++] = flag.whole(0, 1) == 1;
      }
    if (const auto matched = value.find("modes"))
      for (const JsonValue mode : *matched) condensation.modes.push_back(static_cast<int>(mode.whole(0, 10'000'000)));
  }

  void extra_masses(const JsonValue& masses, Frame3ddFile::Modes& modes) {
    hold_only(masses, {"nodes", "members"}, "masses of nodes and members");
    if (const auto nodes = masses.find("nodes"))
      for (const JsonValue entry : *nodes) {
        Frame3ddFile::Modes::NodeInertia extra;
        extra.node = node_of(entry.key());
        if (entry.is_array()) {
          int i = -1;
          for (const JsonValue number : entry) (i < 0 ? extra.mass : extra.inertia[i]) = number.number(), ++i;
        } else {
          extra.mass = entry.number();
        }
        modes.nodes.push_back(extra);
      }
    if (const auto members = masses.find("members"))
      for (const JsonValue entry : *members)
        modes.elements.emplace_back(member_numbers_.at(std::string(entry.key())), entry.number());
  }

  JsonValue root_;
  const Building& building_;
  Frame3ddFile file_;
  double gravity_ = 1;
  std::unordered_map<std::string, int> node_numbers_, member_numbers_;  // looked up only
  std::vector<bool> radius_given_;
  std::vector<double> materials_;  ///< thermal expansion by element
  std::vector<Mat3> axes_;         ///< of each element
  std::vector<std::array<bool, 6>> held_;
  std::optional<bool> shear_;
};

}  // namespace

Frame3ddFile frame3dd_of_model(const JsonDocument& model, const Building& building) {
  return FileMaker(model, building).make();
}

}  // namespace topple::structure
