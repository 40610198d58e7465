#include "model/connect_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "mesh/point_index.h"
#include "model/index_of.h"
#include "topple/structure/divide_member.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

template <class Use>
void for_each_node_id(Building& b, Use use) {
  for (Member& member : b.members)
    for (NodeId& node : member.nodes) use(node);
  for (Panel& panel : b.panels)
    for (NodeId& node : panel.nodes) use(node);
  for (NodeSupport& support : b.supports) use(support.node);
  for (Diaphragm& diaphragm : b.diaphragms)
    for (NodeId& node : diaphragm.nodes) use(node);
  for (NodeMass& mass : b.masses.nodes) use(mass.node);
  for (LoadCase& c : b.cases) {
    for (NodeLoad& load : c.nodes) use(load.node);
    for (Settlement& settlement : c.settlements) use(settlement.node);
  }
}

/// The member straight between its ends as they lie now, turned no more than it must; its loads stretch along.
void set_between_ends(Building& b, MemberId id) {
  Member& member = b.members[index_of(id)];
  const Vec3 span = b[member.nodes[1]].position + member.offsets[1] - b[member.nodes[0]].position - member.offsets[0];
  const double ratio = span.norm() / member.length;
  const Vec3 before = member.axes.row(0);
  if (ratio == 1 && span.normalized() == before) return;
  member.axes = member.axes * Eigen::Quaterniond::FromTwoVectors(before, span).toRotationMatrix().transpose();
  member.length = span.norm();
  for (LoadCase& c : b.cases)
    for (MemberLoad& load : c.members) {
      if (load.member != id) continue;
      load.from *= ratio;
      load.to *= ratio;
    }
}

class Connecting {
 public:
  Connecting(Building& building, double tolerance) : b_(building), tolerance_(tolerance) {}

  Connections run() {
    merge_nodes();
    divide_members();
    return done_;
  }

 private:
  void merge_nodes() {
    std::vector<NodeId> goes_to;
    std::vector<Node> kept;
    PointIndex index(tolerance_);
    for (const Node& node : b_.nodes) {
      const int near = index.nearest(node.position, tolerance_);
      goes_to.emplace_back(near >= 0 ? static_cast<std::size_t>(near) : kept.size());
      if (near >= 0) continue;
      index.add(node.position, static_cast<int>(kept.size()));
      kept.push_back(node);
    }
    done_.merged = b_.nodes.size() - kept.size();
    if (done_.merged == 0) return;
    b_.nodes = std::move(kept);
    for_each_node_id(b_, [&](NodeId& node) { node = goes_to[index_of(node)]; });
    join_supports();
    for (Diaphragm& diaphragm : b_.diaphragms) keep_first_of_each(diaphragm.nodes);
    for (std::size_t m = 0; m < b_.members.size(); ++m) {
      const Member& member = b_.members[m];
      const Vec3 span =
          b_[member.nodes[1]].position + member.offsets[1] - b_[member.nodes[0]].position - member.offsets[0];
      if (member.nodes[0] == member.nodes[1] || !(span.norm() > tolerance_))
        throw InputError(b_.file + ": member " + member.name +
                         " is not longer than the tolerance of `connect`; accepted: a smaller tolerance");
      set_between_ends(b_, MemberId(m));
    }
    for (const Panel& panel : b_.panels) {
      std::vector<NodeId> corners(panel.nodes.begin(), panel.nodes.end());
      keep_first_of_each(corners);
      if (corners.size() < 4)
        throw InputError(
            b_.file + ": panel " + panel.name +
            " has a side that is not longer than the tolerance of `connect`; accepted: a smaller tolerance");
    }
  }

  static void keep_first_of_each(std::vector<NodeId>& nodes) {
    std::vector<NodeId> once;
    for (const NodeId node : nodes)
      if (std::find(once.begin(), once.end(), node) == once.end()) once.push_back(node);
    nodes = std::move(once);
  }

  /// Springs side by side; what either holds is held.
  void join_supports() {
    std::vector<NodeSupport> joined;
    for (const NodeSupport& support : b_.supports) {
      const auto same = std::find_if(joined.begin(), joined.end(),
                                     [&](const NodeSupport& other) { return other.node == support.node; });
      if (same == joined.end())
        joined.push_back(support);
      else
        same->stiffness += support.stiffness;  // unlimited is infinite
    }
    b_.supports = std::move(joined);
  }

  void divide_members() {
    sort_nodes_along_x();
    const std::size_t members = b_.members.size();
    for (std::size_t m = 0; m < members; ++m) {
      const std::vector<std::pair<double, NodeId>> on = nodes_on(b_.members[m]);
      if (on.empty() || b_.members[m].axial != AxialAction::both) continue;
      divide(MemberId(m), on);
      ++done_.divided;
    }
  }

  void sort_nodes_along_x() {
    along_x_.resize(b_.nodes.size());
    std::iota(along_x_.begin(), along_x_.end(), std::size_t{0});
    std::stable_sort(along_x_.begin(), along_x_.end(),
                     [&](std::size_t a, std::size_t b) { return b_.nodes[a].position.x() < b_.nodes[b].position.x(); });
  }

  /// Fractions of the length and nodes, ascending.
  [[nodiscard]] std::vector<std::pair<double, NodeId>> nodes_on(const Member& member) const {
    const Vec3 a = b_[member.nodes[0]].position + member.offsets[0],
               along = b_[member.nodes[1]].position + member.offsets[1] - a;
    const Vec3 low = a.cwiseMin(a + along).array() - tolerance_, high = a.cwiseMax(a + along).array() + tolerance_;
    const auto first = std::lower_bound(along_x_.begin(), along_x_.end(), low.x(),
                                        [&](std::size_t n, double x) { return b_.nodes[n].position.x() < x; });
    std::vector<std::pair<double, NodeId>> found;
    for (auto at = first; at != along_x_.end() && b_.nodes[*at].position.x() <= high.x(); ++at) {
      const NodeId node(*at);
      const Vec3& place = b_.nodes[*at].position;
      if ((place.array() < low.array()).any() || (place.array() > high.array()).any()) continue;
      if (node == member.nodes[0] || node == member.nodes[1]) continue;
      const double fraction = (place - a).dot(along) / along.squaredNorm();
      const bool inside = fraction * member.length > tolerance_ && (1 - fraction) * member.length > tolerance_;
      if (inside && (place - a - fraction * along).norm() <= tolerance_) found.emplace_back(fraction, node);
    }
    std::sort(found.begin(), found.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    return found;
  }

  void divide(MemberId id, const std::vector<std::pair<double, NodeId>>& on) {
    const Member whole = b_[id];
    const std::vector<JointId> cuts = divide_member_at(b_, id, on);
    std::vector<MemberId> pieces{id};
    for (std::size_t i = 1; i <= cuts.size(); ++i) pieces.emplace_back(b_.members.size() - cuts.size() + i - 1);
    double begin = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      Member& piece = b_.members[index_of(pieces[i])];
      if (i > 0) piece.offsets[0] = Vec3::Zero();
      if (i + 1 < pieces.size()) piece.offsets[1] = Vec3::Zero();
      const double end = i + 1 < pieces.size() ? on[i].first * whole.length : whole.length;
      set_between_ends(b_, pieces[i]);
      design_piece(whole, begin, end, piece.design);
      begin = end;
    }
  }

  /// Lengths stay those of the whole, restraints go to the pieces that they lie on.
  static void design_piece(const Member& whole, double begin, double end, MemberDesign& design) {
    for (std::size_t i = 0; i < 3; ++i)
      if (design.factors[i]) {
        design.lengths[i] = *design.factors[i] * whole.length;
        design.factors[i].reset();
      }
    std::vector<double> own;
    for (const double at : whole.design.restraints)
      if (at > begin && at < end) own.push_back(at - begin);
    design.restraints = std::move(own);
  }

  Building& b_;
  double tolerance_;
  Connections done_;
  std::vector<std::size_t> along_x_;
};

}  // namespace

Connections connect_parts(Building& building, double tolerance) { return Connecting(building, tolerance).run(); }

}  // namespace topple::structure
