// The building of a study's page.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "study_page.h"
#include "svg_figure.h"

namespace topple::app {

namespace {

using namespace structure;

/// Light grey where it never happens; from yellow over orange to dark red.
std::string colour_of(double share) {
  if (share <= 0) return "#cdd2d6";
  constexpr std::array<std::array<double, 3>, 5> steps{
      {{254, 225, 130}, {254, 190, 80}, {253, 125, 50}, {227, 26, 28}, {110, 0, 26}}};
  const double at = std::clamp(share, 0.0, 1.0) * 4;
  const auto below = std::min<std::size_t>(3, static_cast<std::size_t>(at));
  std::array<int, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c)
    rgb[c] = static_cast<int>(
        std::lround(steps[below][c] + (at - static_cast<double>(below)) * (steps[below + 1][c] - steps[below][c])));
  char text[32];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", static_cast<unsigned>(rgb[0]), static_cast<unsigned>(rgb[1]),
                static_cast<unsigned>(rgb[2]));
  return text;
}

/// Axonometry: looking along (1, 2, -0.8) or so, further parts first.
class View {
 public:
  explicit View(const Building& building) {
    for (const Node& node : building.nodes) {
      const Vec2 at = flat(node.position);
      low_ = low_.cwiseMin(at);
      high_ = high_.cwiseMax(at);
    }
    scale_ = std::min(width / std::max(high_.x() - low_.x(), 1e-9), height / std::max(high_.y() - low_.y(), 1e-9));
  }
  static constexpr double width = 640, height = 460, edge = 20;
  [[nodiscard]] std::string point(const Vec3& p) const {
    const Vec2 at = (flat(p) - low_) * scale_;
    char text[64];
    std::snprintf(text, sizeof text, "%.1f,%.1f", edge + at.x(), edge + (high_.y() - low_.y()) * scale_ - at.y());
    return text;
  }
  [[nodiscard]] static double depth(const Vec3& p) { return -p.x() * 0.5 + p.y() * 0.866 - p.z() * 0.4; }
  [[nodiscard]] double tall() const { return (high_.y() - low_.y()) * scale_ + 2 * edge; }

 private:
  static Vec2 flat(const Vec3& p) {
    return {p.x() * 0.866 + p.y() * 0.5, p.z() * 0.94 + 0.34 * (p.y() * 0.866 - p.x() * 0.5)};
  }
  Vec2 low_ = Vec2::Constant(1e300), high_ = Vec2::Constant(-1e300);
  double scale_ = 1;
};

struct Shape {
  double depth = 0;
  std::string svg;
};

std::string titled(const std::string& element, const std::string& name, double share, const char* what) {
  char text[64];
  std::snprintf(text, sizeof text, ": %s in %.1f %%", what, 100 * share);
  return element + "><title>" + escaped(name) + text + "</title>";
}

void add_panels(const Building& building, const PartShares& shares, const View& view, std::vector<Shape>& shapes) {
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const Panel& panel = building.panels[p];
    Shape shape;
    std::string points;
    for (const NodeId node : panel.nodes) {
      points += view.point(building[node].position) + " ";
      shape.depth += View::depth(building[node].position) / 4;
    }
    const double share = p < shares.panels.size() ? shares.panels[p] : 0;
    shape.svg = titled("<polygon fill-opacity='" + std::string(share > 0 ? "0.55" : "0.12") + "' fill='" +
                           colour_of(share) + "' points='" + points + "'",
                       panel.name, share, "down") +
                "</polygon>\n";
    shapes.push_back(std::move(shape));
  }
}

void add_members(const Building& building, const PartShares& shares, const View& view, std::vector<Shape>& shapes) {
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    const Member& member = building.members[m];
    const Vec3 a = building[member.nodes[0]].position, b = building[member.nodes[1]].position;
    const double share = m < shares.members.size() ? shares.members[m] : 0;
    shapes.push_back({(View::depth(a) + View::depth(b)) / 2,
                      titled("<polyline fill='none' stroke-width='2.4' stroke='" + colour_of(share) + "' points='" +
                                 view.point(a) + " " + view.point(b) + "'",
                             member.name, share, "down") +
                          "</polyline>\n"});
    for (std::size_t end = 0; end < 2; ++end) {
      const auto j = static_cast<std::size_t>(building.joint(MemberId(m), static_cast<int>(end)).index);
      const double broken = j < shares.joints.size() ? shares.joints[j] : 0;
      if (broken == 0) continue;
      const Vec3 at = end == 0 ? Vec3(a + 0.08 * (b - a)) : Vec3(b + 0.08 * (a - b));
      const std::string where = view.point(at);
      const std::size_t comma = where.find(',');
      shapes.push_back(
          {View::depth(at), titled("<circle r='3.4' stroke='#333' stroke-width='0.4' cx='" + where.substr(0, comma) +
                                       "' cy='" + where.substr(comma + 1) + "' fill='" + colour_of(broken) + "'",
                                   building.joints[j].name, broken, "broken or overloaded") +
                                "</circle>\n"});
    }
  }
}

}  // namespace

std::string building_drawing(const Building& building, const PartShares& shares) {
  const View view(building);
  std::vector<Shape> shapes;
  add_panels(building, shares, view, shapes);
  add_members(building, shares, view, shapes);
  std::stable_sort(shapes.begin(), shapes.end(), [](const Shape& a, const Shape& b) { return a.depth > b.depth; });
  char size[96];
  std::snprintf(size, sizeof size, "<svg class='building' viewBox='0 0 %.0f %.0f' role='img'>\n",
                View::width + 2 * View::edge, view.tall() + 34);
  std::string text = size;
  for (const Shape& shape : shapes) text += shape.svg;
  // The scale.
  const auto bar = [&](double x, double width, double share) {
    char rect[160];
    std::snprintf(rect, sizeof rect, "<rect x='%.0f' y='%.0f' width='%.0f' height='10' fill='%s'/>", x, view.tall() + 4,
                  width, colour_of(share).c_str());
    text += rect;
  };
  const auto label = [&](double x, const char* says) {
    char element[120];
    std::snprintf(element, sizeof element, "<text x='%.0f' y='%.0f' text-anchor='middle'>%s</text>", x,
                  view.tall() + 28, says);
    text += element;
  };
  bar(20, 40, 0);
  label(40, "never");
  constexpr double from = 76, step = 12;
  for (int i = 0; i < 20; ++i) bar(from + step * i, step, (i + 0.5) / 20.0);
  for (const auto& [share, says] : {std::pair(0.0, "0"), {0.25, "25 %"}, {0.5, "50 %"}, {0.75, "75 %"}, {1.0, "100 %"}})
    label(from + step * 20 * share, says);
  return text + "</svg>\n";
}

}  // namespace topple::app
