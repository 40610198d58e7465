#pragma once
// A Frame3DD input file (.3dd, version 2014) as it stands: its numbers, in its own order and units. Format: Frame3DD
// user manual, H. P. Gavin, section "Input data format". Parts are counted from 0 here, from 1 in the file.
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

struct Frame3ddFile {
  std::string title;

  struct Node {
    Vec3 place = Vec3::Zero();
    double radius = 0;   ///< rigid, of every element's end at the node
    std::string remark;  ///< for a comment beside it; never read
  };
  std::vector<Node> nodes;

  struct Reaction {
    int node = 0;
    std::array<bool, 6> held{};
  };
  std::vector<Reaction> reactions;

  struct Element {
    std::array<int, 2> nodes{};
    std::array<double, 6> section{};  ///< Ax Asy Asz Jxx Iyy Izz
    double E = 0, G = 0;
    double roll = 0;  ///< degrees
    double density = 0;
    std::string remark;
  };
  std::vector<Element> elements;

  bool shear_deformation = false, geometric_stiffness = false;
  double exaggeration = 10, zoom = 1, increment = -1;  ///< how Frame3DD draws; -1: no forces along elements

  struct NodeNumbers {
    int node = 0;
    Vec6 values = Vec6::Zero();
  };
  struct Uniform {
    int element = 0;
    Vec3 load = Vec3::Zero();  ///< local axes, as all loads on elements
  };
  struct Trapezoid {
    int element = 0;
    std::array<std::array<double, 4>, 3> axes{};  ///< x1 x2 w1 w2 along local x, y, z
  };
  struct Point {
    int element = 0;
    Vec3 load = Vec3::Zero();
    double place = 0;
  };
  struct Temperature {
    int element = 0;
    double expansion = 0;
    std::array<double, 2> depth{1, 1};             ///< hy, hz
    std::array<std::array<double, 2>, 2> faces{};  ///< Ty+ Ty-, Tz+ Tz-
  };
  struct LoadCase {
    std::string remark;
    Vec3 gravity = Vec3::Zero();  ///< acceleration
    std::vector<NodeNumbers> nodes;
    std::vector<Uniform> uniform;
    std::vector<Trapezoid> trapezoids;
    std::vector<Point> points;
    std::vector<Temperature> temperatures;
    std::vector<NodeNumbers> displacements;
  };
  std::vector<LoadCase> cases;

  // Constructors of their own: clang has none for them as long as the class around them is not whole.
  struct Condensation {
    Condensation() {}
    int method = 0;
    struct NodeFlags {
      int node = 0;
      std::array<bool, 6> flags{};
    };
    std::vector<NodeFlags> nodes;
    std::vector<int> modes;
  };
  struct Modes {
    Modes() {}
    int count = 0, method = 1;
    bool lumped = false;
    double tolerance = 1e-9, shift = 0, exaggeration = 10;
    struct NodeInertia {
      int node = 0;
      double mass = 0;
      Vec3 inertia = Vec3::Zero();
    };
    std::vector<NodeInertia> nodes;
    std::vector<std::pair<int, double>> elements;  ///< extra mass
    std::optional<std::vector<int>> animated;      ///< absent: the file ends before
    std::optional<double> pan;
    std::optional<Condensation> condensation;
  };
  std::optional<Modes> modes;
};

/// Throws InputError with file, line, what was found and what is accepted.
[[nodiscard]] Frame3ddFile parse_frame3dd_file(std::string_view text, const std::string& name);

/// The text that parse_frame3dd_file() reads back to the same bits.
[[nodiscard]] std::string frame3dd_text(const Frame3ddFile& file);

/// Axes (rows x, y, z) of an element along `along`, as Frame3DD has them: y horizontal; for a vertical element y = +Y,
/// whichever way it points; then the roll (degrees).
[[nodiscard]] Mat3 frame3dd_axes(const Vec3& along, double roll);

}  // namespace topple::structure
