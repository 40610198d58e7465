// The numbers of a .3dd file as text, each in the shortest form that reads back to the same bits.
#include <charconv>

#include "formats/frame3dd/frame3dd_file.h"

namespace topple::structure {

namespace {

class Text {
 public:
  Text& number(double value) {
    char digits[32];
    return word({digits, std::to_chars(digits, digits + sizeof digits, value).ptr});
  }
  Text& number(int value) { return word(std::to_string(value)); }
  Text& flag(bool value) { return word(value ? "1" : "0"); }
  template <class Numbers>
  Text& numbers(const Numbers& values) {
    for (const double value : values) number(value);
    return *this;
  }
  /// Ends the line, with a comment when there is one.
  void end(std::string_view comment = {}) {
    if (!comment.empty()) {
      text_ += "  # ";
      for (const char c : comment) text_ += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    text_ += '\n';
    fresh_ = true;
  }
  void raw(std::string_view text) { text_ += text; }
  [[nodiscard]] std::string release() { return std::move(text_); }

 private:
  Text& word(std::string_view text) {
    if (!fresh_) text_ += ' ';
    fresh_ = false;
    text_ += text;
    return *this;
  }
  std::string text_;
  bool fresh_ = true;
};

int count(std::size_t size) { return static_cast<int>(size); }

void write_structure(Text& text, const Frame3ddFile& file) {
  text.number(count(file.nodes.size())).end("nodes: number, x, y, z, radius");
  for (std::size_t i = 0; i < file.nodes.size(); ++i)
    text.number(count(i + 1)).numbers(file.nodes[i].place).number(file.nodes[i].radius).end(file.nodes[i].remark);
  text.number(count(file.reactions.size())).end("nodes with reactions: number, x, y, z, xx, yy, zz (1: held)");
  for (const auto& reaction : file.reactions) {
    text.number(reaction.node + 1);
    for (const bool held : reaction.held) text.flag(held);
    text.end();
  }
  text.number(count(file.elements.size()))
      .end("elements: number, nodes, Ax, Asy, Asz, Jxx, Iyy, Izz, E, G, roll, density");
  for (std::size_t i = 0; i < file.elements.size(); ++i) {
    const auto& e = file.elements[i];
    text.number(count(i + 1)).number(e.nodes[0] + 1).number(e.nodes[1] + 1).numbers(e.section);
    text.number(e.E).number(e.G).number(e.roll).number(e.density).end(e.remark);
  }
  text.flag(file.shear_deformation).end("shear deformation");
  text.flag(file.geometric_stiffness).end("geometric stiffness");
  text.number(file.exaggeration).end("exaggeration of deformations");
  text.number(file.zoom).end("zoom scale");
  text.number(file.increment).end("x-axis increment (-1: none)");
}

void write_node_numbers(Text& text, const std::vector<Frame3ddFile::NodeNumbers>& list, const char* what) {
  text.number(count(list.size())).end(what);
  for (const auto& item : list) {
    text.number(item.node + 1).numbers(item.values);
    text.end();
  }
}

void write_case(Text& text, const Frame3ddFile::LoadCase& load_case, std::size_t index) {
  text.numbers(load_case.gravity)
      .end("case " + std::to_string(index + 1) + (load_case.remark.empty() ? "" : " (" + load_case.remark + ")") +
           ": gravity X, Y, Z");
  write_node_numbers(text, load_case.nodes, "loaded nodes");
  text.number(count(load_case.uniform.size())).end("uniform loads (local axes)");
  for (const auto& load : load_case.uniform) text.number(load.element + 1).numbers(load.load).end();
  text.number(count(load_case.trapezoids.size())).end("trapezoidal loads: x1, x2, w1, w2 along local x, y, z");
  for (const auto& load : load_case.trapezoids) {
    text.number(load.element + 1);
    for (const auto& axis : load.axes) text.numbers(axis);
    text.end();
  }
  text.number(count(load_case.points.size())).end("concentrated loads on elements");
  for (const auto& load : load_case.points) text.number(load.element + 1).numbers(load.load).number(load.place).end();
  text.number(count(load_case.temperatures.size())).end("temperature loads: alpha, hy, hz, Ty+, Ty-, Tz+, Tz-");
  for (const auto& load : load_case.temperatures)
    text.number(load.element + 1)
        .number(load.expansion)
        .numbers(load.depth)
        .numbers(load.faces[0])
        .numbers(load.faces[1])
        .end();
  write_node_numbers(text, load_case.displacements, "prescribed displacements");
}

void write_condensation(Text& text, const Frame3ddFile::Condensation& condensation) {
  text.number(condensation.method).end("condensation method");
  if (condensation.method == 0) return;
  text.number(count(condensation.nodes.size())).end("condensed nodes");
  for (const auto& node : condensation.nodes) {
    text.number(node.node + 1);
    for (const bool flag : node.flags) text.flag(flag);
    text.end();
  }
  for (const int mode : condensation.modes) text.number(mode);
  text.end();
}

void write_modes(Text& text, const Frame3ddFile::Modes& modes) {
  text.number(modes.count).end("dynamic modes");
  if (modes.count == 0) return;
  text.number(modes.method).end("eigenvalue method: 1 subspace, 2 Stodola");
  text.flag(modes.lumped).end("0: consistent mass, 1: lumped");
  text.number(modes.tolerance).end("mode shape tolerance");
  text.number(modes.shift).end("shift");
  text.number(modes.exaggeration).end("exaggeration of modes");
  text.number(count(modes.nodes.size())).end("nodes with extra inertia: mass, Ixx, Iyy, Izz");
  for (const auto& extra : modes.nodes) text.number(extra.node + 1).number(extra.mass).numbers(extra.inertia).end();
  text.number(count(modes.elements.size())).end("elements with extra mass");
  for (const auto& [element, mass] : modes.elements) text.number(element + 1).number(mass).end();
  if (!modes.animated) return;
  text.number(count(modes.animated->size()));
  for (const int mode : *modes.animated) text.number(mode);
  text.end("modes to animate");
  if (!modes.pan) return;
  text.number(*modes.pan).end("pan rate");
  if (modes.condensation) write_condensation(text, *modes.condensation);
}

}  // namespace

std::string frame3dd_text(const Frame3ddFile& file) {
  Text text;
  text.raw(file.title + "\n");
  write_structure(text, file);
  text.number(count(file.cases.size())).end("static load cases");
  for (std::size_t k = 0; k < file.cases.size(); ++k) write_case(text, file.cases[k], k);
  if (file.modes) write_modes(text, *file.modes);
  return text.release();
}

}  // namespace topple::structure
