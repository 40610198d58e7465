// A .3dd file as a JSON model: every number as it stands, but for the roll, which becomes radians.
#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>

#include "formats/json/json_writer.h"
#include "formats/model_forms.h"

namespace topple::structure {

namespace {

constexpr std::array<const char*, 2> element_axes{"y", "z"};

class ModelWriter {
 public:
  explicit ModelWriter(const Frame3ddFile& file)
      : file_(file), expansion_(file.elements.size()), held_(file.nodes.size()) {
    for (const auto& reaction : file.reactions) held_[static_cast<std::size_t>(reaction.node)] = reaction.held;
    // A material has one coefficient: the first that is not zero counts for the element, as in the reader.
    for (const auto& load_case : file.cases)
      for (const auto& heat : load_case.temperatures)
        if (auto& known = expansion_[static_cast<std::size_t>(heat.element)]; !known && heat.expansion != 0)
          known = heat.expansion;
  }

  std::string write() {
    w_.open('{').key("topple").value(std::size_t{1}).key("title").value(file_.title);
    w_.key("units").value("consistent").key("gravity").value(1.0).newline();
    analyses();
    drawing();
    name_materials_and_sections();
    materials();
    sections();
    nodes();
    members();
    supports();
    if (file_.modes && file_.modes->count > 0) masses(*file_.modes);
    loads();
    combinations();
    w_.close('}');
    return w_.release() + "\n";
  }

 private:
  static std::string numbered(std::size_t index) { return std::to_string(index + 1); }
  static std::string numbered(int index) { return std::to_string(index + 1); }
  JsonWriter& whole(int value) { return w_.value(static_cast<std::size_t>(value)); }

  void analyses() {
    const bool modes = file_.modes && file_.modes->count > 0;
    if (!file_.geometric_stiffness && !modes) return;
    w_.key("analyses").open('{');
    if (file_.geometric_stiffness) w_.key("p_delta").value("cubic");
    if (modes) {
      w_.key("modes");
      whole(file_.modes->count).key("mass").value(file_.modes->lumped ? "lumped" : "consistent");
      w_.key("shift").value(file_.modes->shift);
    }
    w_.close('}').newline();
  }

  /// What Frame3DD alone reads.
  void drawing() {
    w_.key("frame3dd").open('{').key("exaggeration").value(file_.exaggeration).key("zoom").value(file_.zoom);
    w_.key("increment").value(file_.increment);
    if (file_.modes) {
      const Frame3ddFile::Modes& modes = *file_.modes;
      w_.key("method");
      whole(modes.method).key("tolerance").value(modes.tolerance).key("mode_exaggeration").value(modes.exaggeration);
      if (modes.animated) {
        w_.key("animated").open('[');
        for (const int mode : *modes.animated) whole(mode);
        w_.close(']');
      }
      if (modes.pan) w_.key("pan").value(*modes.pan);
      if (modes.condensation) condensation(*modes.condensation);
    }
    w_.close('}').newline();
  }

  void condensation(const Frame3ddFile::Condensation& condensation) {
    w_.key("condensation").open('{').key("method");
    whole(condensation.method).key("nodes").open('{');
    for (const auto& node : condensation.nodes) {
      w_.key(numbered(node.node)).open('[');
      for (const bool flag : node.flags) w_.value(std::size_t{flag});
      w_.close(']');
    }
    w_.close('}').key("modes").open('[');
    for (const int mode : condensation.modes) whole(mode);
    w_.close(']').close('}');
  }

  void name_materials_and_sections() {
    for (std::size_t i = 0; i < file_.elements.size(); ++i) {
      const auto& e = file_.elements[i];
      const std::array<double, 5> key{e.E, e.G, e.density, expansion_[i].value_or(0), expansion_[i] ? 1.0 : 0.0};
      material_of_.push_back(index_of(key, materials_));
      section_of_.push_back(index_of(e.section, sections_));
    }
  }
  template <class Key>
  static std::size_t index_of(const Key& key, std::map<Key, std::size_t>& known) {
    return known.try_emplace(key, known.size()).first->second;
  }
  template <class Key>
  static std::vector<Key> in_order(const std::map<Key, std::size_t>& known) {
    std::vector<Key> keys(known.size());
    for (const auto& [key, index] : known) keys[index] = key;
    return keys;
  }

  void materials() {
    w_.key("materials").open('{');
    const auto list = in_order(materials_);
    for (std::size_t i = 0; i < list.size(); ++i) {
      w_.newline().key("material " + numbered(i)).open('{').key("youngs_modulus").value(list[i][0]);
      w_.key("shear_modulus").value(list[i][1]).key("density").value(list[i][2]);
      if (list[i][4] != 0) w_.key("thermal_expansion").value(list[i][3]);
      w_.close('}');
    }
    w_.close('}').newline();
  }

  void sections() {
    w_.key("sections").open('{');
    const auto list = in_order(sections_);
    constexpr std::array<const char*, 6> keys{"area", "shear_area_y", "shear_area_z", "J", "Iy", "Iz"};
    for (std::size_t i = 0; i < list.size(); ++i) {
      w_.newline().key("section " + numbered(i)).open('{');
      for (std::size_t k = 0; k < keys.size(); ++k) w_.key(keys[k]).value(list[i][k]);
      if (!file_.shear_deformation) w_.key("shear_deformation").value(false);
      w_.close('}');
    }
    w_.close('}').newline();
  }

  void point(const Vec3& p) {
    w_.open('[');
    for (const double value : p) w_.value(value);
    w_.close(']');
  }

  void nodes() {
    w_.key("nodes").open('{');
    for (std::size_t i = 0; i < file_.nodes.size(); ++i) {
      w_.newline().key(numbered(i));
      point(file_.nodes[i].place);
    }
    w_.close('}').newline();
  }

  void members() {
    w_.key("members").open('{');
    for (std::size_t i = 0; i < file_.elements.size(); ++i) {
      const Frame3ddFile::Element& e = file_.elements[i];
      const Frame3ddFile::Node& first = file_.nodes[static_cast<std::size_t>(e.nodes[0])];
      const Frame3ddFile::Node& second = file_.nodes[static_cast<std::size_t>(e.nodes[1])];
      const Vec3 along = second.place - first.place;
      const Mat3 axes = frame3dd_axes(along, 0);
      w_.newline().key(numbered(i)).open('{').key("nodes").open('[');
      w_.value(numbered(e.nodes[0])).value(numbered(e.nodes[1])).close(']');
      w_.key("section").value("section " + numbered(section_of_[i]));
      w_.key("material").value("material " + numbered(material_of_[i]));
      // Topple's default is the same as Frame3DD's but where the element is (nearly) upright.
      if (along.head<2>().norm() < 1e-5 * along.norm()) {
        w_.key("up");
        point(axes.row(2).transpose());
      }
      if (e.roll != 0) w_.key("roll").value(e.roll * std::numbers::pi / 180);
      if (first.radius > 0 || second.radius > 0) {
        const Vec3 x = axes.row(0).transpose();
        w_.key("offsets").open('[');
        point(first.radius * x);
        point(-second.radius * x);
        w_.close(']');
      }
      w_.close('}');
    }
    w_.close('}').newline();
  }

  void supports() {
    w_.key("supports").open('{');
    for (const auto& reaction : file_.reactions) {
      w_.newline().key(numbered(reaction.node)).open('{');
      for (std::size_t i = 0; i < 6; ++i)
        if (reaction.held[i]) w_.key(component_names[i]).value(true);
      w_.close('}');
    }
    w_.close('}').newline();
  }

  void masses(const Frame3ddFile::Modes& modes) {
    if (modes.nodes.empty() && modes.elements.empty()) return;
    w_.key("masses").open('{').key("nodes").open('{');
    for (const auto& extra : modes.nodes) {
      w_.key(numbered(extra.node)).open('[').value(extra.mass);
      for (const double inertia : extra.inertia) w_.value(inertia);
      w_.close(']');
    }
    w_.close('}').key("members").open('{');
    for (const auto& [element, mass] : modes.elements) w_.key(numbered(element)).value(mass);
    w_.close('}').close('}').newline();
  }

  void loads() {
    w_.key("loads").open('{');
    for (std::size_t k = 0; k < file_.cases.size(); ++k) {
      const Frame3ddFile::LoadCase& given = file_.cases[k];
      w_.newline().key("case " + numbered(k)).open('{');
      if (!given.gravity.isZero(0)) {
        w_.key("self_weight");
        point(given.gravity);
      }
      node_numbers("nodes", given.nodes);
      member_loads(given);
      node_numbers("settlements", given.displacements);
      w_.close('}');
    }
    w_.close('}').newline();
  }

  /// All six numbers of a load; of a prescribed displacement those of held freedoms.
  void node_numbers(const char* key, const std::vector<Frame3ddFile::NodeNumbers>& list) {
    if (list.empty()) return;
    const bool movements = std::string_view(key) == "settlements";
    w_.key(key).open('{');
    for (const auto& item : list) {
      w_.newline().key(numbered(item.node)).open('{');
      for (std::size_t i = 0; i < 6; ++i)
        if (!movements || is_held(item.node, i)) w_.key(component_names[i]).value(item.values[static_cast<int>(i)]);
      w_.close('}');
    }
    w_.close('}');
  }
  [[nodiscard]] bool is_held(int node, std::size_t component) const {
    return held_[static_cast<std::size_t>(node)][component];
  }

  /// By element, as the file first names them; within one in the order of the file's blocks.
  void member_loads(const Frame3ddFile::LoadCase& given) {
    std::map<int, std::vector<const Frame3ddFile::Uniform*>> uniform;
    std::map<int, std::vector<const Frame3ddFile::Trapezoid*>> trapezoids;
    std::map<int, std::vector<const Frame3ddFile::Point*>> points;
    std::map<int, std::vector<const Frame3ddFile::Temperature*>> heat;
    std::vector<int> loaded;  // in the order of the file
    std::vector<bool> seen(file_.elements.size(), false);
    const auto sort = [&](const auto& list, auto& by_element) {
      for (const auto& load : list) {
        by_element[load.element].push_back(&load);
        if (!seen[static_cast<std::size_t>(load.element)]) loaded.push_back(load.element);
        seen[static_cast<std::size_t>(load.element)] = true;
      }
    };
    sort(given.uniform, uniform);
    sort(given.trapezoids, trapezoids);
    sort(given.points, points);
    sort(given.temperatures, heat);
    if (loaded.empty()) return;
    w_.key("members").open('{');
    for (const int element : loaded) {
      w_.newline().key(numbered(element)).open('[');
      for (const auto* load : uniform[element]) {
        w_.open('{').key("uniform");
        components(load->load);
        w_.key("frame").value("local").close('}');
      }
      for (const auto* load : trapezoids[element]) trapezoid(*load);
      for (const auto* load : points[element]) {
        w_.open('{').key("point");
        components(load->load);
        w_.key("at").value(load->place).key("frame").value("local").close('}');
      }
      for (const auto* load : heat[element]) temperature(*load);
      w_.close(']');
    }
    w_.close('}');
  }

  void components(const Vec3& load) {
    w_.open('{');
    for (std::size_t i = 0; i < 3; ++i) w_.key(component_names[i]).value(load[static_cast<int>(i)]);
    w_.close('}');
  }

  /// Each axis has a stretch of its own: one load for each that has one.
  void trapezoid(const Frame3ddFile::Trapezoid& load) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& [x1, x2, w1, w2] = load.axes[i];
      if (!(x2 > x1)) continue;
      w_.open('{').key("trapezoid").open('{').key(component_names[i]).open('[').value(w1).value(w2).close(']');
      w_.close('}').key("from").value(x1).key("to").value(x2).key("frame").value("local").close('}');
    }
  }

  void temperature(const Frame3ddFile::Temperature& load) {
    w_.open('{').key("temperature").open('{').key("expansion").value(load.expansion);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string axis = element_axes[i];
      w_.key("depth_" + axis).value(load.depth[i]);
      w_.key("faces_" + axis).open('[').value(load.faces[i][0]).value(load.faces[i][1]).close(']');
    }
    w_.close('}').close('}');
  }

  void combinations() {
    w_.key("combinations").open('{');
    for (std::size_t k = 0; k < file_.cases.size(); ++k) {
      const std::string name = "case " + numbered(k);
      w_.key(name).open('{').key(name).value(std::size_t{1}).close('}');
    }
    w_.close('}');
  }

  const Frame3ddFile& file_;
  std::vector<std::optional<double>> expansion_;
  std::vector<std::array<bool, 6>> held_;
  std::map<std::array<double, 5>, std::size_t> materials_;
  std::map<std::array<double, 6>, std::size_t> sections_;
  std::vector<std::size_t> material_of_, section_of_;
  JsonWriter w_;
};

}  // namespace

std::string model_of_frame3dd(const Frame3ddFile& file) { return ModelWriter(file).write(); }

}  // namespace topple::structure
