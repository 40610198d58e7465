#include "edge_placement.h"

#include <Eigen/Geometry>
#include <cmath>

#include "model/index_of.h"

namespace topple::structure {

namespace {

/// Of the length: pieces shorter than this are rounding.
constexpr double negligible = 1e-12;

void add_node_load(TributaryLoads& result, NodeId node, const Vec3& force, const Vec3& moment) {
  for (solver::NodeLoad& load : result.nodes)
    if (load.node == node.index) {
      load.load.head<3>() += force;
      load.load.tail<3>() += moment;
      return;
    }
  Vec6 load;
  load << force, moment;
  result.nodes.push_back({node.index, load});
}

EdgeLoad part(const EdgeLoad& load, double from, double to) { return {from, to, load.at(from), load.at(to)}; }

}  // namespace

EdgePlacement::EdgePlacement(const Building& building, const EdgeMembers& edges, PanelId panel, int edge,
                             const std::vector<bool>& member_stands)
    : building_(building) {
  const auto& corners = building[panel].nodes;
  const NodeId first = corners[static_cast<std::size_t>(edge)],
               last = corners[static_cast<std::size_t>((edge + 1) % 4)];
  start_ = building[first].position;
  const Vec3 whole = building[last].position - start_;
  length_ = whole.norm();
  direction_ = whole / length_;
  NodeId here = first;
  for (const MemberId member : edges.of(panel, edge)) {
    const auto& nodes = building[member].nodes;
    const NodeId next = nodes[0] == here ? nodes[1] : nodes[0];
    const bool stands = member_stands.empty() || member_stands[index_of(member)];
    const double from = stretches_.empty() ? 0 : stretches_.back().to;
    const double to = next == last ? length_ : position_of(next);
    const bool joins_gap = !stands && !stretches_.empty() && !stretches_.back().member.valid();
    if (joins_gap) {
      stretches_.back().last = next;
      stretches_.back().to = to;
    } else {
      stretches_.push_back({stands ? member : MemberId(), here, next, from, to});
    }
    here = next;
  }
  if (stretches_.empty()) stretches_.push_back({MemberId(), first, last, 0, length_});
}

void EdgePlacement::add(const EdgeLoad& load, TributaryLoads& result) const {
  if (load.first.isZero(0) && load.last.isZero(0)) return;
  for (std::size_t i = 0; i < stretches_.size(); ++i) {
    const Stretch& stretch = stretches_[i];
    const double from = std::max(load.from, stretch.from), to = std::min(load.to, stretch.to);
    const bool whole = from == load.from && to == load.to;
    if (!whole && !(to - from > negligible * length_)) continue;
    const EdgeLoad here = whole ? load : part(load, from, to);
    if (stretch.member.valid())
      add_to_member(stretch, here, result);
    else
      add_over_gap(i, here, result);
    if (whole) return;
  }
}

void EdgePlacement::add_to_member(const Stretch& stretch, const EdgeLoad& load, TributaryLoads& result) const {
  const Member& member = building_[stretch.member];
  const Vec3 axis = member.axes.row(0);
  const Vec3 end = building_[member.nodes[0]].position + member.offsets[0];
  const double slope = direction_.dot(axis), x0 = axis.dot(start_ - end);
  constexpr double least_slope = 0.1;  // an axis turned so far by its offsets has no place for most of the load
  const double at_start = (0 - x0) / slope, at_end = (member.length - x0) / slope;  // edge places of the member's ends
  const double low = std::min(at_start, at_end), high = std::max(at_start, at_end);
  const double a = std::min(std::max(load.from, low), high), b = std::max(std::min(load.to, high), low);
  const double slack = negligible * length_;
  if (std::abs(slope) < least_slope || !(b - a > slack)) {
    share_by_lever(stretch.first, stretch.from, stretch.last, stretch.to, load, result);
    return;
  }
  if (a - load.from > slack) add_to_node(stretch.first, part(load, load.from, a), result);
  if (load.to - b > slack) add_to_node(stretch.last, part(load, b, load.to), result);
  const bool whole = a - load.from <= slack && load.to - b <= slack;
  const EdgeLoad inside = whole ? load : part(load, a, b);
  // Eccentricity of the edge from the axis: a distributed moment. Its product with the force is quadratic; the linear
  // moment has its end values but for what makes the integral exact.
  const auto eccentricity = [&](double s) -> Vec3 {
    const Vec3 p = start_ + s * direction_ - end;
    const Vec3 e = p - axis * axis.dot(p);
    return e.norm() > negligible * length_ ? e : Vec3(Vec3::Zero());
  };
  const Vec3 e0 = eccentricity(inside.from), e1 = eccentricity(inside.to);
  const Vec3 &f0 = inside.first, &f1 = inside.last;
  const Vec3 m0 = e0.cross(f0), m1 = e1.cross(f1);
  const Vec3 surplus = (m0 + m1) / 6 - (e0.cross(f1) + e1.cross(f0)) / 6;
  solver::BeamLoad beam;
  beam.beam = stretch.member.index;
  const double stretching = 1 / std::abs(slope);
  beam.from = std::clamp(x0 + slope * inside.from, 0.0, member.length);
  beam.to = std::clamp(x0 + slope * inside.to, 0.0, member.length);
  beam.first << member.axes * f0 * stretching, member.axes * (m0 - surplus) * stretching;
  beam.last << member.axes * f1 * stretching, member.axes * (m1 - surplus) * stretching;
  if (slope < 0) {
    std::swap(beam.from, beam.to);
    std::swap(beam.first, beam.last);
  }
  result.beams.push_back(beam);
}

void EdgePlacement::add_to_node(NodeId node, const EdgeLoad& load, TributaryLoads& result) const {
  const double arm = load.from - position_of(node);
  add_node_load(result, node, load.resultant(), direction_.cross(load.moment() + arm * load.resultant()));
}

void EdgePlacement::share_by_lever(NodeId a, double at_a, NodeId b, double at_b, const EdgeLoad& load,
                                   TributaryLoads& result) const {
  const Vec3 total = load.resultant();
  const Vec3 to_b = (load.moment() + (load.from - at_a) * total) / (at_b - at_a);
  add_node_load(result, a, total - to_b, Vec3::Zero());
  add_node_load(result, b, to_b, Vec3::Zero());
}

void EdgePlacement::add_over_gap(std::size_t gap, const EdgeLoad& load, TributaryLoads& result) const {
  const Stretch &own = stretches_[gap], *before = gap > 0 ? &stretches_[gap - 1] : nullptr,
                *after = gap + 1 < stretches_.size() ? &stretches_[gap + 1] : nullptr;
  // Neighbouring gaps are one, so whatever is next to a gap stands.
  const Stretch* standing = before != nullptr && after != nullptr ? nullptr : (before != nullptr ? before : after);
  const Stretch& held = standing != nullptr ? *standing : own;
  share_by_lever(held.first, held.from, held.last, held.to, load, result);
}

}  // namespace topple::structure
