// The text of a .3dd file to its numbers.
#include <algorithm>
#include <cmath>

#include "formats/frame3dd/frame3dd_file.h"
#include "formats/frame3dd/frame3dd_tokens.h"

namespace topple::structure {

namespace {

constexpr int most_parts = 10'000'000;  // of one kind: a count beyond it is a slip of the pen, not a model

constexpr int most_degrees = 1'000'000;

constexpr std::array<const char*, 3> force_names{"X", "Y", "Z"};
constexpr std::array<const char*, 6> freedom_names{"x", "y", "z", "xx", "yy", "zz"};

class Parser {
 public:
  Parser(std::string_view text, const std::string& name) : tokens_(text, name) { file_.title = tokens_.title(); }

  Frame3ddFile parse() {
    read_nodes();
    read_reactions();
    read_elements();
    read_settings();
    read_load_cases();
    if (!tokens_.at_end()) read_modes();
    return std::move(file_);
  }

 private:
  void read_nodes() {
    const int count = tokens_.count("the number of nodes", 2, 5);
    std::vector<bool> seen(static_cast<std::size_t>(count), false);
    file_.nodes.resize(seen.size());
    for (int k = 0; k < count; ++k) {
      const int n = numbered("node", count, seen);
      Frame3ddFile::Node& node = file_.nodes[static_cast<std::size_t>(n)];
      const std::string of = " of node " + std::to_string(n + 1);
      for (std::size_t i = 0; i < 3; ++i) node.place[static_cast<int>(i)] = tokens_.number(freedom_names[i] + of);
      node.radius = std::abs(tokens_.number("the radius" + of));  // Frame3DD takes the size of it
    }
  }

  void read_reactions() {
    const int count = tokens_.whole("the number of nodes with reactions", 0, node_count());
    std::vector<bool> seen(file_.nodes.size(), false);
    held_.resize(file_.nodes.size());
    for (int k = 0; k < count; ++k) {
      Frame3ddFile::Reaction reaction;
      reaction.node = numbered("node with reactions", node_count(), seen);
      for (std::size_t i = 0; i < 6; ++i)
        reaction.held[i] =
            tokens_.flag(std::string("reaction ") + freedom_names[i] + " of node " + std::to_string(reaction.node + 1));
      held_[static_cast<std::size_t>(reaction.node)] = reaction.held;
      file_.reactions.push_back(reaction);
    }
  }

  void read_elements() {
    const int count = tokens_.count("the number of frame elements", 1, 12);
    std::vector<bool> seen(static_cast<std::size_t>(count), false);
    file_.elements.resize(seen.size());
    lengths_.resize(seen.size());
    for (int k = 0; k < count; ++k) read_element(numbered("frame element", count, seen));
  }

  void read_element(int index) {
    Frame3ddFile::Element& element = file_.elements[static_cast<std::size_t>(index)];
    const std::string of = " of element " + std::to_string(index + 1);
    for (std::size_t end = 0; end < 2; ++end)
      element.nodes[end] = tokens_.whole((end == 0 ? "node 1" : "node 2") + of, 1, node_count()) - 1;
    constexpr std::array<const char*, 6> properties{"Ax", "Asy", "Asz", "Jxx", "Iyy", "Izz"};
    for (std::size_t i = 0; i < 6; ++i) {
      const bool shear_area = i == 1 || i == 2;
      element.section[i] =
          shear_area ? tokens_.number_from(properties[i] + of, 0) : tokens_.number_above(properties[i] + of, 0);
    }
    element.E = tokens_.number_above("E" + of, 0);
    element.G = tokens_.number_above("G" + of, 0);
    element.roll = tokens_.number("roll" + of);
    if (std::abs(element.roll) > most_degrees)
      tokens_.fail("roll" + of + ": found an angle beyond " + std::to_string(most_degrees) + " degrees");
    element.density = tokens_.number_from("density" + of, 0);
    measure(index);
  }

  void measure(int index) {
    const Frame3ddFile::Element& element = file_.elements[static_cast<std::size_t>(index)];
    const Frame3ddFile::Node& first = file_.nodes[static_cast<std::size_t>(element.nodes[0])];
    const Frame3ddFile::Node& second = file_.nodes[static_cast<std::size_t>(element.nodes[1])];
    const double distance = (second.place - first.place).norm();
    const std::string name = "element " + std::to_string(index + 1);
    if (!(distance > 0)) tokens_.fail(name + " has no length");
    if (!std::isfinite(distance)) tokens_.fail(name + " is longer than numbers reach");
    double& length = lengths_[static_cast<std::size_t>(index)];
    length = distance - first.radius - second.radius;
    if (!(length > 0)) tokens_.fail(name + " is shorter than the radii of its nodes");
  }

  void read_settings() {
    file_.shear_deformation = tokens_.flag("the shear deformation flag");
    file_.geometric_stiffness = tokens_.flag("the geometric stiffness flag");
    file_.exaggeration = tokens_.number("the exaggeration of deformations");
    file_.zoom = tokens_.number("the zoom scale");
    file_.increment = tokens_.number("the x-axis increment");
    for (std::size_t i = 0; file_.shear_deformation && i < file_.elements.size(); ++i)
      if (!(file_.elements[i].section[1] > 0 && file_.elements[i].section[2] > 0))
        tokens_.fail("Asy and Asz of element " + std::to_string(i + 1) +
                     " must be above 0 when the shear deformation flag is 1");
  }

  void read_load_cases() {
    const int count = tokens_.count("the number of static load cases", 1, 9);
    for (int k = 1; k <= count; ++k) {
      name_ = "case " + std::to_string(k);
      Frame3ddFile::LoadCase& load_case = file_.cases.emplace_back();
      for (std::size_t i = 0; i < 3; ++i)
        load_case.gravity[static_cast<int>(i)] =
            tokens_.number(std::string("gravity ") + force_names[i] + " of " + name_);
      read_node_loads(load_case);
      read_uniform_loads(load_case);
      read_trapezoidal_loads(load_case);
      read_point_loads(load_case);
      read_temperature_loads(load_case);
      read_displacements(load_case);
    }
  }

  void read_node_loads(Frame3ddFile::LoadCase& load_case) {
    const int count = tokens_.whole("the number of loaded nodes of " + name_, 0, node_count());
    std::vector<bool> seen(file_.nodes.size(), false);
    for (int k = 0; k < count; ++k) {
      const int n = numbered("loaded node", node_count(), seen);
      load_case.nodes.push_back({n, six_numbers("load", n)});
    }
  }

  void read_uniform_loads(Frame3ddFile::LoadCase& load_case) {
    const int count = tokens_.whole("the number of uniform loads of " + name_, 0, most_parts);
    for (int k = 0; k < count; ++k) {
      Frame3ddFile::Uniform& load = load_case.uniform.emplace_back();
      load.element = loaded_element();
      for (std::size_t i = 0; i < 3; ++i)
        load.load[static_cast<int>(i)] = tokens_.number(std::string("uniform load U") + freedom_names[i]);
    }
  }

  void read_trapezoidal_loads(Frame3ddFile::LoadCase& load_case) {
    const int count = tokens_.whole("the number of trapezoidal loads of " + name_, 0, most_parts);
    for (int k = 0; k < count; ++k) {
      Frame3ddFile::Trapezoid& load = load_case.trapezoids.emplace_back();
      load.element = loaded_element();
      for (std::size_t i = 0; i < 3; ++i) {
        auto& [x1, x2, w1, w2] = load.axes[i];
        const std::string axis = std::string(" of the trapezoidal load along ") + freedom_names[i];
        x1 = tokens_.number_from("x1" + axis, 0);
        x2 = tokens_.number_from("x2" + axis, x1);
        w1 = tokens_.number("w1" + axis);
        w2 = tokens_.number("w2" + axis);
        if (w1 == 0 && w2 == 0) continue;
        check_within(x2, load.element);
        if (!(std::min(x2, length_of(load.element)) > x1)) tokens_.fail("x2" + axis + " must be above x1");
      }
    }
  }

  void read_point_loads(Frame3ddFile::LoadCase& load_case) {
    const int count = tokens_.whole("the number of internal concentrated loads of " + name_, 0, most_parts);
    for (int k = 0; k < count; ++k) {
      Frame3ddFile::Point& load = load_case.points.emplace_back();
      load.element = loaded_element();
      for (std::size_t i = 0; i < 3; ++i)
        load.load[static_cast<int>(i)] = tokens_.number(std::string("point load P") + freedom_names[i]);
      load.place = tokens_.number_from("x of the point load", 0);
      check_within(load.place, load.element);
    }
  }

  void read_temperature_loads(Frame3ddFile::LoadCase& load_case) {
    const int count = tokens_.whole("the number of temperature loads of " + name_, 0, most_parts);
    for (int k = 0; k < count; ++k) {
      Frame3ddFile::Temperature& load = load_case.temperatures.emplace_back();
      load.element = loaded_element();
      load.expansion = tokens_.number("alpha of the temperature load");
      load.depth[0] = tokens_.number_above("hy of the temperature load", 0);
      load.depth[1] = tokens_.number_above("hz of the temperature load", 0);
      constexpr std::array<const char*, 4> names{"Ty+", "Ty-", "Tz+", "Tz-"};
      for (std::size_t i = 0; i < 4; ++i) load.faces[i / 2][i % 2] = tokens_.number(names[i]);
    }
  }

  void read_displacements(Frame3ddFile::LoadCase& load_case) {
    const int count = tokens_.whole("the number of nodes with prescribed displacements of " + name_, 0, node_count());
    std::vector<bool> seen(file_.nodes.size(), false);
    for (int k = 0; k < count; ++k) {
      const int n = numbered("node with prescribed displacements", node_count(), seen);
      const Vec6 values = six_numbers("displacement", n);
      for (std::size_t i = 0; i < 6; ++i)
        if (values[static_cast<int>(i)] != 0 && !held_[static_cast<std::size_t>(n)][i])
          tokens_.fail("displacement " + std::string(freedom_names[i]) + " of node " + std::to_string(n + 1) +
                       " is prescribed where the node has no reaction");
      load_case.displacements.push_back({n, values});
    }
  }

  void read_modes() {
    Frame3ddFile::Modes& modes = file_.modes.emplace();
    modes.count = tokens_.whole("the number of dynamic modes", 0, most_parts);
    if (modes.count == 0) return;
    modes.method = tokens_.whole("the eigenvalue method", 1, 2);
    modes.lumped = tokens_.flag("the lumped mass flag");
    modes.tolerance = tokens_.number_above("the mode shape tolerance", 0);
    modes.shift = tokens_.number("the shift");
    modes.exaggeration = tokens_.number("the exaggeration of modes");
    read_extra_masses(modes);
    if (tokens_.at_end()) return;
    modes.animated.emplace();
    const int animated = tokens_.whole("the number of modes to animate", 0, most_parts);
    for (int k = 0; k < animated; ++k) modes.animated->push_back(tokens_.whole("a mode to animate", 1, most_parts));
    if (!tokens_.at_end()) modes.pan = tokens_.number("the pan rate");
    if (!tokens_.at_end()) read_condensation(modes.condensation.emplace());
  }

  void read_extra_masses(Frame3ddFile::Modes& modes) {
    const int nodes = tokens_.whole("the number of nodes with extra inertia", 0, node_count());
    std::vector<bool> seen(file_.nodes.size(), false);
    for (int k = 0; k < nodes; ++k) {
      Frame3ddFile::Modes::NodeInertia& extra = modes.nodes.emplace_back();
      extra.node = numbered("node with extra inertia", node_count(), seen);
      const std::string of = " of node " + std::to_string(extra.node + 1);
      extra.mass = tokens_.number_from("the extra mass" + of, 0);
      for (std::size_t i = 0; i < 3; ++i)
        extra.inertia[static_cast<int>(i)] =
            tokens_.number_from(std::string("the inertia I") + freedom_names[3 + i] + of, 0);
    }
    const int elements = tokens_.whole("the number of elements with extra mass", 0, element_count());
    std::vector<bool> seen_element(file_.elements.size(), false);
    for (int k = 0; k < elements; ++k) {
      const int e = numbered("element with extra mass", element_count(), seen_element);
      modes.elements.emplace_back(e, tokens_.number_from("the extra mass of element " + std::to_string(e + 1), 0));
    }
  }

  void read_condensation(Frame3ddFile::Condensation& condensation) {
    condensation.method = tokens_.whole("the condensation method", 0, 3);
    if (condensation.method == 0) return;
    const int nodes = tokens_.whole("the number of condensed nodes", 0, node_count());
    std::vector<bool> seen(file_.nodes.size(), false);
    int condensed = 0;
    for (int k = 0; k < nodes; ++k) {
      auto& node = condensation.nodes.emplace_back();
      node.node = numbered("condensed node", node_count(), seen);
      for (std::size_t i = 0; i < 6; ++i) {
        node.flags[i] = tokens_.flag(std::string("the condensation flag ") + freedom_names[i] + " of node " +
                                     std::to_string(node.node + 1));
        condensed += node.flags[i];
      }
    }
    for (int k = 0; k < condensed && !tokens_.at_end(); ++k)
      condensation.modes.push_back(tokens_.whole("a mode to match", 0, most_parts));
  }

  /// Reads the number of a part, 1 to count, each once; returns it from 0.
  int numbered(const char* part, int count, std::vector<bool>& seen) {
    const int n = tokens_.whole(std::string("the number of a ") + part, 1, count) - 1;
    if (seen[static_cast<std::size_t>(n)])
      tokens_.fail(std::string(part) + " " + std::to_string(n + 1) + " is given twice");
    seen[static_cast<std::size_t>(n)] = true;
    return n;
  }

  Vec6 six_numbers(const std::string& kind, int node) {
    Vec6 values;
    for (std::size_t i = 0; i < 6; ++i)
      values[static_cast<int>(i)] =
          tokens_.number(kind + " " + freedom_names[i] + " of node " + std::to_string(node + 1));
    return values;
  }

  int loaded_element() { return tokens_.whole("the number of a loaded element", 1, element_count()) - 1; }
  [[nodiscard]] double length_of(int element) const { return lengths_[static_cast<std::size_t>(element)]; }

  /// A place may pass the element's end by the rounding of printed coordinates, not by more.
  void check_within(double place, int element) const {
    constexpr double rounding = 1e-6;
    if (place > length_of(element) * (1 + rounding))
      tokens_.fail("a load lies beyond the end of element " + std::to_string(element + 1) + ", whose length is " +
                   std::to_string(length_of(element)));
  }

  [[nodiscard]] int node_count() const { return static_cast<int>(file_.nodes.size()); }
  [[nodiscard]] int element_count() const { return static_cast<int>(file_.elements.size()); }

  Frame3ddTokens tokens_;
  Frame3ddFile file_;
  std::vector<std::array<bool, 6>> held_;
  std::vector<double> lengths_;
  std::string name_;
};

}  // namespace

Frame3ddFile parse_frame3dd_file(std::string_view text, const std::string& name) { return Parser(text, name).parse(); }

}  // namespace topple::structure
