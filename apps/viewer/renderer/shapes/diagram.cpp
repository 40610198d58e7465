#include "renderer/shapes/diagram.h"

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

namespace topple::viewer {
namespace {

constexpr float fill_alpha = 0.55F;

/// The straight line between a member's drawn ends, and its axes.
struct Axis {
  glm::vec3 first, last;
  glm::quat turn;
  explicit Axis(const MemberInstance& m)
      : first(m.first_end + m.displacement1), turn(m.rotation.w, m.rotation.x, m.rotation.y, m.rotation.z) {
    last = m.first_end + turn * glm::vec3(m.length, 0, 0) + m.displacement2;
  }
  [[nodiscard]] glm::vec3 at(float share) const { return glm::mix(first, last, share); }
};

class Band {
 public:
  Band(Overlay& overlay, const Axis& axis, glm::vec3 direction) : overlay_(overlay), axis_(axis), out_(direction) {}

  /// Between two places, at which the values have one sign.
  void piece(float s0, float v0, float s1, float v1) {
    const Rgba colour = signed_colour(v0 + v1 < 0 ? -1 : 1);
    const Rgba fill = with_alpha(colour, fill_alpha);
    const glm::vec3 a = axis_.at(s0), b = axis_.at(s1), c = b + out_ * v1, d = a + out_ * v0;
    for (const glm::vec3& p : {a, b, c, a, c, d}) overlay_.triangles.push_back({p, fill});
    overlay_.lines.push_back({d, colour});
    overlay_.lines.push_back({c, colour});
  }
  void ordinate(float s, float v) {
    const Rgba colour = signed_colour(v < 0 ? -1 : 1);
    overlay_.lines.push_back({axis_.at(s), colour});
    overlay_.lines.push_back({axis_.at(s) + out_ * v, colour});
  }

 private:
  Overlay& overlay_;
  const Axis& axis_;
  glm::vec3 out_;
};

void add_line(Overlay& overlay, const glm::vec3& a, const glm::vec3& b, Rgba colour) {
  overlay.lines_on_top.push_back({a, colour});
  overlay.lines_on_top.push_back({b, colour});
}

}  // namespace

glm::vec3 diagram_direction(int component) {
  switch (component) {
    case 1:
    case 3:
      return {0, 1, 0};
    case 5:
      return {0, -1, 0};
    default:
      return {0, 0, 1};
  }
}

void add_diagram(Overlay& overlay, const MemberInstance& member, const float* values, int intervals, int component,
                 float reach) {
  const Axis axis(member);
  Band band(overlay, axis, axis.turn * diagram_direction(component));
  const auto place = [intervals](int i) { return static_cast<float>(i) / static_cast<float>(intervals); };
  for (int i = 0; i < intervals; ++i) {
    const float v0 = reach * values[i], v1 = reach * values[i + 1], s0 = place(i), s1 = place(i + 1);
    if (v0 * v1 < 0) {
      const float crossing = glm::mix(s0, s1, v0 / (v0 - v1));
      band.piece(s0, v0, crossing, 0);
      band.piece(crossing, 0, s1, v1);
    } else if (v0 != 0 || v1 != 0) {
      band.piece(s0, v0, s1, v1);
    }
  }
  band.ordinate(0, reach * values[0]);
  band.ordinate(1, reach * values[intervals]);
}

void add_mark(Overlay& overlay, const MemberInstance& member, glm::vec2 half_size, Rgba colour) {
  const Axis axis(member);
  const auto corner = [&](int i, const glm::vec3& end) {
    const glm::vec2 side((i & 1) != 0 ? half_size.x : -half_size.x, (i & 2) != 0 ? half_size.y : -half_size.y);
    return end + axis.turn * glm::vec3(0, side);
  };
  constexpr int around[] = {0, 1, 3, 2};
  for (int i = 0; i < 4; ++i) {
    const int a = around[i], b = around[(i + 1) % 4];
    add_line(overlay, corner(a, axis.first), corner(b, axis.first), colour);
    add_line(overlay, corner(a, axis.last), corner(b, axis.last), colour);
    add_line(overlay, corner(a, axis.first), corner(a, axis.last), colour);
  }
}

void add_mark(Overlay& overlay, const PanelInstance& panel, Rgba colour) {
  for (int i = 0; i < 4; ++i) add_line(overlay, panel.corner[i], panel.corner[(i + 1) % 4], colour);
}

}  // namespace topple::viewer
