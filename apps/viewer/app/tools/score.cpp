#include "app/tools/score.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "renderer/instances/scene_instances.h"

namespace topple::viewer {
namespace {

using structure::Building;
using structure::Vec3;

/// By the divergence theorem, over the mesh's triangles.
double volume(const fracture::Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](std::size_t i) -> const Vec3& { return mesh.positions[static_cast<std::size_t>(t[i])]; };
    sum += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  return sum;
}

double opening_area(const structure::Panel& panel) {
  double sum = 0;
  for (const auto& opening : panel.openings) {
    double twice = 0;
    for (std::size_t i = 0; i < opening.size(); ++i) {
      const auto &a = opening[i], &b = opening[(i + 1) % opening.size()];
      twice += a.x() * b.y() - b.x() * a.y();
    }
    sum += std::abs(twice) / 2;
  }
  return sum;
}

class Weighing {
 public:
  Weighing(const Building& building, const Snapshot& moment) : building_(building), moment_(moment) {
    const Bounds bounds = bounds_of(building);
    low_ = Vec3(bounds.low.x - score_margin, bounds.low.y - score_margin, 0);
    high_ = Vec3(bounds.high.x + score_margin, bounds.high.y + score_margin, 0);
  }
  void add(const structure::Member& member, int place) {
    const double mass = building_[member.material].density * building_[member.section].area * member.length;
    whole_ += mass;
    add_mass(mass, (building_[member.nodes[0]].position + building_[member.nodes[1]].position) / 2, place);
  }
  void add(const structure::Panel& panel, int place, const fracture::Mesh* rest) {
    const auto corner = [&](std::size_t i) -> const Vec3& { return building_[panel.nodes[i]].position; };
    const double area = (corner(2) - corner(0)).cross(corner(3) - corner(1)).norm() / 2 - opening_area(panel);
    const double density = building_[panel.material].density, mass = density * area * panel.thickness;
    whole_ += mass;
    add_mass(rest != nullptr ? density * volume(*rest) : mass, (corner(0) + corner(1) + corner(2) + corner(3)) / 4,
             place);
  }
  void add(const BodyPose& body) {
    if (!body.chunk || !body.material.valid()) return;
    lies(building_[body.material].density * volume(*body.chunk), body.position);
  }
  [[nodiscard]] Score score(int actions) const {
    Score score;
    score.actions = actions;
    if (whole_ > 0) score.down = std::clamp(1 - standing_ / whole_, 0.0, 1.0);
    if (lying_ > 0) score.inside = inside_ / lying_;
    return score;
  }

 private:
  /// `at`: where it was in the undeformed building.
  void add_mass(double mass, const Vec3& at, int place) {
    if (place == part_stands) standing_ += mass;
    if (place < 0) return;
    const BodyPose& body = moment_.bodies[static_cast<std::size_t>(place)];
    lies(mass, body.position + body.orientation * (at - body.rest_centre));
  }
  void lies(double mass, const Vec3& at) {
    lying_ += mass;
    if (at.x() >= low_.x() && at.x() <= high_.x() && at.y() >= low_.y() && at.y() <= high_.y()) inside_ += mass;
  }
  const Building& building_;
  const Snapshot& moment_;
  Vec3 low_, high_;
  double whole_ = 0, standing_ = 0, lying_ = 0, inside_ = 0;
};

}  // namespace

int Score::points() const {
  const double all = 100 * down * inside;
  return static_cast<int>(std::lround(std::max(0.0, all * (1 - 0.1 * std::max(0, actions - 1)))));
}

Score score_of(const Building& building, const Snapshot& moment, int actions) {
  Weighing weighing(building, moment);
  const Membership& where = *moment.membership;
  for (std::size_t i = 0; i < building.members.size(); ++i) weighing.add(building.members[i], where.member[i]);
  for (std::size_t i = 0; i < building.panels.size(); ++i)
    weighing.add(building.panels[i], where.panel[i], i < where.broken.size() ? where.broken[i].get() : nullptr);
  for (const BodyPose& body : moment.bodies) weighing.add(body);
  return weighing.score(actions);
}

}  // namespace topple::viewer
