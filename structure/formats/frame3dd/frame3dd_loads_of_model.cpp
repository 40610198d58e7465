// The load cases of a .3dd file from a model's: a combination becomes a case.
#include <cmath>
#include <limits>
#include <set>

#include "formats/frame3dd/frame3dd_of_model.h"
#include "formats/model_reader.h"

namespace topple::structure {

namespace {

using formats::JsonValue;
using frame3dd_model::hold_only;
using frame3dd_model::number_or;
using frame3dd_model::refuse;

class LoadCaseMaker {
 public:
  LoadCaseMaker(const JsonValue& root, const Frame3ddNumbers& numbers, Frame3ddFile& file)
      : root_(root), numbers_(numbers), file_(file) {}

  void make() {
    const auto loads = root_.find("loads");
    if (!loads || loads->size() == 0) root_.fail("no `loads`; accepted in a .3dd file: at least one load case");
    const auto combinations = root_.find("combinations");
    if (!combinations || combinations->size() == 0) {
      for (const JsonValue value : *loads) {
        start(value.key());
        add_case(value, 1);
      }
      return;
    }
    std::set<std::string_view> used;
    for (const JsonValue combination : *combinations) {
      start(combination.key());
      for (const JsonValue factor : combination) {
        used.insert(factor.key());
        add_case(loads->require(factor.key()), factor.number());
      }
    }
    for (const JsonValue value : *loads)
      if (!used.contains(value.key())) refuse(value, "load cases that a combination has");
  }

 private:
  void start(std::string_view name) {
    Frame3ddFile::LoadCase& made = file_.cases.emplace_back();
    if (const std::string own = "case " + std::to_string(file_.cases.size()); name != own) made.remark = name;
    last_axis_ = 3;
  }
  Frame3ddFile::LoadCase& made() { return file_.cases.back(); }

  void add_case(const JsonValue& value, double factor) {
    hold_only(value, {"self_weight", "nodes", "members", "settlements"},
              "self weight, loads of nodes and members, settlements");
    factor_ = factor;
    if (const auto weight = value.find("self_weight")) {
      const Vec3 direction = weight->is_array() ? formats::read_point(*weight, 1) : Vec3(0, 0, -weight->number());
      made().gravity += factor_ * Vec3(numbers_.gravity * direction);
    }
    if (const auto nodes = value.find("nodes"))
      for (const JsonValue entry : *nodes) add_six(entry, made().nodes);
    if (const auto settlements = value.find("settlements"))
      for (const JsonValue entry : *settlements) add_six(entry, made().displacements);
    if (const auto members = value.find("members"))
      for (const JsonValue list : *members)
        for (const JsonValue entry : list) member_load(entry, numbers_.members.at(std::string(list.key())));
  }

  /// A node stands once in a case.
  void add_six(const JsonValue& entry, std::vector<Frame3ddFile::NodeNumbers>& list) const {
    const int node = numbers_.nodes.at(std::string(entry.key()));
    const Vec6 values = factor_ * formats::read_components(entry, [](int) { return 1.0; });
    for (auto& known : list)
      if (known.node == node) {
        known.values += values;
        return;
      }
    list.push_back({node, values});
  }

  void member_load(const JsonValue& value, int element) {
    if (const auto temperature = value.find("temperature")) return this->temperature(*temperature, element);
    if (const auto uniform = value.find("uniform")) {
      const Vec3 load = along_axes(value, components(*uniform), element);
      if (value.find("from") || value.find("to"))
        stretch(value, load, load, element);
      else
        made().uniform.push_back({element, load});
    } else if (const auto trapezoid = value.find("trapezoid")) {
      this->trapezoid(value, *trapezoid, element);
    } else if (const auto point = value.find("point")) {
      made().points.push_back({element, along_axes(value, components(*point), element), value.require("at").number()});
    }
  }

  /// Forces; moments along an element are more than a .3dd file can hold.
  [[nodiscard]] Vec3 components(const JsonValue& object) const {
    for (const JsonValue value : object)
      if (formats::component_of(value.key()) > 2 && value.number() != 0) refuse(value, "forces x, y, z");
    return factor_ * formats::read_components(object, [](int) { return 1.0; }).head<3>();
  }

  /// A load in the frame that it names, along the element's axes.
  [[nodiscard]] Vec3 along_axes(const JsonValue& load, Vec3 force, int element) const {
    const auto frame = load.find("frame");
    if (frame && frame->text() == "local") return force;
    const Mat3& axes = numbers_.axes[static_cast<std::size_t>(element)];
    // Per length of the element seen along each global axis: what is left of it across that axis.
    if (frame && frame->text() == "projected" && !load.find("point"))
      for (int i = 0; i < 3; ++i) force[i] *= std::hypot(axes(0, (i + 1) % 3), axes(0, (i + 2) % 3));
    Vec3 local = axes * force;
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * force.norm();
    for (double& component : local)
      if (std::abs(component) <= rounding) component = 0;
    return local;
  }

  /// `from` and `to`, which default to the ends.
  [[nodiscard]] std::array<double, 2> extent(const JsonValue& value, int element) const {
    const Frame3ddFile::Element& e = file_.elements[static_cast<std::size_t>(element)];
    const auto node = [&](std::size_t end) { return file_.nodes[static_cast<std::size_t>(e.nodes[end])]; };
    const double length = (node(1).place - node(0).place).norm() - node(0).radius - node(1).radius;
    return {number_or(value, "from", 0), number_or(value, "to", length)};
  }

  /// A load of a part of the element, of intensity `first` at its beginning and `last` at its end.
  void stretch(const JsonValue& value, const Vec3& first, const Vec3& last, int element) {
    const auto [from, to] = extent(value, element);
    Frame3ddFile::Trapezoid part{element, {}};
    for (std::size_t i = 0; i < 3; ++i)
      if (const auto k = static_cast<int>(i); first[k] != 0 || last[k] != 0)
        part.axes[i] = {from, to, first[k], last[k]};
    made().trapezoids.push_back(part);
    last_axis_ = 3;
  }

  void trapezoid(const JsonValue& value, const JsonValue& components, int element) {
    Vec3 first = Vec3::Zero(), last = Vec3::Zero();
    int lowest = 3, highest = -1;
    for (const JsonValue pair : components) {
      const int axis = formats::component_of(pair.key());
      auto number = pair.begin();
      const double w1 = (*number).number();
      ++number;
      const double w2 = (*number).number();
      if (axis > 2) {
        if (w1 != 0 || w2 != 0) refuse(pair, "forces x, y, z");
        continue;
      }
      first[axis] = factor_ * w1;
      last[axis] = factor_ * w2;
      lowest = std::min(lowest, axis);
      highest = std::max(highest, axis);
    }
    const auto frame = value.find("frame");
    if (!frame || frame->text() != "local")
      return stretch(value, along_axes(value, first, element), along_axes(value, last, element), element);
    // Loads on following axes of one element are one load of the file, as they came from one.
    const auto [from, to] = extent(value, element);
    if (made().trapezoids.empty() || made().trapezoids.back().element != element || lowest <= last_axis_)
      made().trapezoids.push_back({element, {}});
    for (int axis = lowest; axis <= highest; ++axis)
      if (components.find(component_names[static_cast<std::size_t>(axis)]))
        made().trapezoids.back().axes[static_cast<std::size_t>(axis)] = {from, to, first[axis], last[axis]};
    last_axis_ = highest;
  }

  void temperature(const JsonValue& value, int element) {
    Frame3ddFile::Temperature heat;
    heat.element = element;
    heat.expansion = numbers_.expansion[static_cast<std::size_t>(element)];
    if (value.find("faces_y") || value.find("faces_z")) {
      heat.expansion = number_or(value, "expansion", heat.expansion);
      constexpr std::array<const char*, 2> depths{"depth_y", "depth_z"}, faces{"faces_y", "faces_z"};
      for (std::size_t i = 0; i < 2; ++i) {
        heat.depth[i] = value.require(depths[i]).number();
        std::size_t k = 0;
        for (const JsonValue face : value.require(faces[i])) heat.faces[i][k++] = factor_ * face.number();
      }
    } else {
      // Faces one length apart, so that their difference is the gradient.
      const double even = factor_ * number_or(value, "uniform", 0);
      constexpr std::array<const char*, 2> gradients{"gradient_y", "gradient_z"};
      for (std::size_t i = 0; i < 2; ++i) {
        const double half = factor_ * number_or(value, gradients[i], 0) / 2;
        heat.faces[i] = {even + half, even - half};
      }
    }
    made().temperatures.push_back(heat);
  }

  const JsonValue root_;
  const Frame3ddNumbers& numbers_;
  Frame3ddFile& file_;
  double factor_ = 1;
  int last_axis_ = 3;  ///< of the trapezoidal load written last; 3: nothing may be added to it
};

}  // namespace

void frame3dd_load_cases(const JsonValue& root, const Frame3ddNumbers& numbers, Frame3ddFile& file) {
  LoadCaseMaker(root, numbers, file).make();
}

}  // namespace topple::structure
