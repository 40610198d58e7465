#include "app/picking.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::viewer {
namespace {

using structure::Building;
using structure::Member;
using structure::MemberKind;
using structure::Panel;
using structure::Vec3;

Vec3 to_eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// The ray in the undeformed building: for a part of a body, moved back with it.
struct LocalRay {
  Vec3 origin, direction;
};
LocalRay undo_motion(const LocalRay& ray, const BodyPose& body) {
  const Eigen::Quaterniond back = body.orientation.conjugate();
  return {back * (ray.origin - body.position) + body.rest_centre, back * ray.direction};
}

/// Distance along a ray to a box from `low` to `high`, or infinity.
double hit_box(const Vec3& origin, const Vec3& direction, const Vec3& low, const Vec3& high) {
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (int c = 0; c < 3; ++c) {
    const double a = (low[c] - origin[c]) / direction[c], b = (high[c] - origin[c]) / direction[c];
    if (std::isnan(a) || std::isnan(b)) continue;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

bool shown(MemberKind kind, const PartSwitches& s) {
  return kind == MemberKind::post ? s.posts : kind == MemberKind::beam ? s.beams : s.braces;
}
bool shown(structure::PanelKind kind, const PartSwitches& s) {
  return kind == structure::PanelKind::slab ? s.slabs : s.walls;
}

class Picker {
 public:
  Picker(const Building& building, const LocalRay& ray) : building_(building), ray_(ray) {}

  void member(structure::MemberId id, const LocalRay& ray) {
    const Member& member = building_[id];
    const structure::Section& section = building_[member.section];
    const double side = std::sqrt(section.area);
    const double width = section.width > 0 ? section.width : side, depth = section.depth > 0 ? section.depth : side;
    const Vec3 end = building_[member.nodes[0]].position + member.offsets[0];
    const Vec3 origin = member.axes * (ray.origin - end), direction = member.axes * ray.direction;
    const double at = hit_box(origin, direction, {0, -width / 2, -depth / 2}, {member.length, width / 2, depth / 2});
    if (!nearer(at)) return;
    best_.member = id;
    best_.panel = {};
    best_.joint = building_.joint(id, (origin + at * direction).x() > member.length / 2 ? 1 : 0);
  }

  void panel(structure::PanelId id, const LocalRay& ray) {
    const Panel& panel = building_[id];
    const Vec3 corner = building_[panel.nodes[0]].position;
    const Vec3 origin = panel.axes * (ray.origin - corner), direction = panel.axes * ray.direction;
    const double at = -origin.z() / direction.z();
    if (!(at > 0) || at >= best_.distance) return;
    const Vec3 p = origin + at * direction;
    int nearest_edge = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (int edge = 0; edge < 4; ++edge) {
      const auto local = [&](int i) {
        return Vec3(panel.axes * (building_[panel.nodes[static_cast<std::size_t>(i % 4)]].position - corner));
      };
      const Vec3 a = local(edge), along = local(edge + 1) - a;
      const double inside = (along.x() * (p.y() - a.y()) - along.y() * (p.x() - a.x())) / along.norm();
      if (inside < 0) return;
      if (inside < nearest) nearest = inside, nearest_edge = edge;
    }
    if (!nearer(at)) return;
    best_.panel = id;
    best_.member = {};
    best_.joint = building_.joint(id, nearest_edge);
  }

  void ground(double height) {
    const double at = (height - ray_.origin.z()) / ray_.direction.z();
    if (!(at > 0) || !nearer(at)) return;
    best_.member = {};
    best_.panel = {};
    best_.joint = {};
  }

  [[nodiscard]] std::optional<Pick> result() const {
    if (best_.distance == std::numeric_limits<double>::infinity()) return std::nullopt;
    Pick pick = best_;
    const Vec3 p = ray_.origin + pick.distance * ray_.direction;
    pick.point = {p.x(), p.y(), p.z()};
    return pick;
  }

 private:
  bool nearer(double at) {
    if (!(at < best_.distance)) return false;
    best_.distance = at;
    return true;
  }
  const Building& building_;
  LocalRay ray_;
  Pick best_{{}, {}, {}, glm::dvec3(0), std::numeric_limits<double>::infinity()};
};

}  // namespace

std::optional<Pick> pick(const Building& building, const Snapshot& snapshot, const ViewOptions& options, double ground,
                         const Ray& ray) {
  const LocalRay global{to_eigen(ray.origin), to_eigen(ray.direction)};
  std::vector<LocalRay> of_body;
  for (const BodyPose& body : snapshot.bodies) of_body.push_back(undo_motion(global, body));
  const auto ray_for = [&](int place) -> const LocalRay& {
    return place == part_stands ? global : of_body[static_cast<std::size_t>(place)];
  };
  Picker picker(building, global);
  for (std::size_t i = 0; i < building.members.size(); ++i) {
    const int place = snapshot.membership->member[i];
    if (place != part_gone && shown(building.members[i].kind, options.shown))
      picker.member(structure::MemberId(i), ray_for(place));
  }
  for (std::size_t i = 0; i < building.panels.size(); ++i) {
    const int place = snapshot.membership->panel[i];
    if (place != part_gone && shown(building.panels[i].kind, options.shown))
      picker.panel(structure::PanelId(i), ray_for(place));
  }
  picker.ground(ground);
  return picker.result();
}

}  // namespace topple::viewer
