#include "simulation/impact/body_impact.h"

#include <algorithm>
#include <cmath>

#include "simulation/impact/impact_settings.h"

namespace topple::structure {

std::vector<int> independent_places(const Eigen::MatrixXd& compliance) {
  std::vector<int> kept;
  Eigen::MatrixXd left = compliance;
  for (Eigen::Index k = 0; k < left.rows(); ++k) {
    if (!(left(k, k) > impact_settings.same_place * compliance(k, k))) continue;
    kept.push_back(static_cast<int>(k));
    const Eigen::VectorXd column = left.col(k) / left(k, k);
    left -= (column * left.row(k)).eval();
  }
  return kept;
}

namespace {

using Demands = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// What a joint bears by unit amplitudes of the modes of the struck nodes; null: it does not go with them.
const Demands* demands_by_mode(const StandingFrame::HeldResponse& response, JointId joint) {
  const auto found = std::find_if(response.node_demands.begin(), response.node_demands.end(),
                                  [joint](const auto& one) { return one.first == joint; });
  return found == response.node_demands.end() ? nullptr : &found->second;
}

/// What a hinge does to the modes of unit modal mass as it turns: the same as they do to its moment.
double by_hinge(const StandingFrame::HeldResponse& response, const StandingFrame::HeldResponse::Hinge& hinge,
                Eigen::Index mode) {
  const Demands* by_mode = demands_by_mode(response, hinge.joint);
  return by_mode ? (*by_mode)(hinge.axis, mode) : 0.0;
}

/// Whether the push or a hinge that turns moves it.
bool is_reached(const StandingFrame::HeldResponse& response, const Eigen::VectorXd& local, Eigen::Index mode) {
  constexpr double none = 1e-9;
  for (Eigen::Index i = 0; i < local.size(); ++i)
    if (std::pow(response.pushed(mode, i), 2) > none * local(i)) return true;
  return std::any_of(response.hinges.begin(), response.hinges.end(), [&](const auto& hinge) {
    return std::pow(by_hinge(response, hinge, mode), 2) > none * hinge.stiffness * response.squared(mode);
  });
}

/// What joints of the side bear by a unit of turning of each hinge, the struck nodes held.
void begin_hinge_demands(ImpactSide& side) {
  const auto& hinges = side.response.hinges;
  side.hinge_demands.assign(side.flexibility.demands.size(),
                            Demands::Zero(6, static_cast<Eigen::Index>(hinges.size())));
  for (std::size_t k = 0; k < side.hinge_demands.size(); ++k)
    for (std::size_t h = 0; h < hinges.size(); ++h)
      for (const auto& [joint, demand] : hinges[h].demands)
        if (joint == side.flexibility.demands[k].first)
          side.hinge_demands[k].col(static_cast<Eigen::Index>(h)) = demand;
}

/// And what this mode adds to that: `squared` is its stiffness for a unit of mass.
void add_hinge_demands(ImpactSide& side, Eigen::Index mode, double squared) {
  const auto& hinges = side.response.hinges;
  for (std::size_t k = 0; !hinges.empty() && k < side.hinge_demands.size(); ++k)
    if (const Demands* by_mode = demands_by_mode(side.response, side.flexibility.demands[k].first))
      for (std::size_t h = 0; h < hinges.size(); ++h)
        side.hinge_demands[k].col(static_cast<Eigen::Index>(h)) +=
            by_mode->col(mode) * (by_hinge(side.response, hinges[h], mode) / squared);
}

}  // namespace

/// Which modes of the struck nodes the push moves. The faster ones bear it as at rest.
void BodyImpact::follow() {
  ImpactSide& side = sides[1];
  const StandingFrame::HeldResponse& response = side.response;
  const Eigen::MatrixXd body = mobility(sides[0].motion, places);
  const Eigen::VectorXd local = response.pushed.colwise().squaredNorm();
  double own = 0;  // rad/s, of the push by itself
  for (Eigen::Index i = 0; i < local.size(); ++i)
    own = std::max(own, std::sqrt((body(i, i) + local(i)) / compliance(i, i)));
  const double fast = impact_settings.follows * own, slow = own / (impact_settings.follows * impact_settings.follows);
  begin_hinge_demands(side);
  side.modes.clear();
  std::vector<double> give;
  for (Eigen::Index mode = 0; mode < response.squared.size(); ++mode) {
    if (!is_reached(response, local, mode)) continue;
    const double squared = response.squared(mode);
    if (squared <= fast * fast) {
      side.modes.push_back(static_cast<int>(mode));
      give.push_back(1 / std::max(squared, slow * slow));
      add_hinge_demands(side, mode, std::max(squared, slow * slow));
      continue;
    }
    const Eigen::RowVectorXd moved = response.pushed.row(mode) / squared;
    compliance += response.pushed.row(mode).transpose() * moved;
    for (auto& [joint, columns] : side.flexibility.demands)
      if (const Demands* by_mode = demands_by_mode(response, joint)) columns += by_mode->col(mode) * moved;
    add_hinge_demands(side, mode, squared);
  }
  side.mode_compliance = Eigen::Map<const Eigen::VectorXd>(give.data(), static_cast<Eigen::Index>(give.size()));
  side.mode_demands.clear();
  for (const auto& [joint, columns] : side.flexibility.demands) {
    const Demands* by_mode = demands_by_mode(response, joint);
    side.mode_demands.emplace_back(by_mode
                                       ? Demands((*by_mode)(Eigen::all, side.modes) * side.mode_compliance.asDiagonal())
                                       : Demands::Zero(6, side.mode_compliance.size()));
  }
}

Eigen::MatrixXd BodyImpact::followed_mobility() const {
  if (!sides[1].held) return mobility_of_both();
  const Eigen::MatrixXd pushed = sides[1].response.pushed(sides[1].modes, Eigen::all);
  const Eigen::Index n = compliance.rows(), m = pushed.rows();
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n + m, n + m);
  all.topLeftCorner(n, n) = mobility(sides[0].motion, places) + pushed.transpose() * pushed;
  all.topRightCorner(n, m) = -pushed.transpose();
  all.bottomLeftCorner(m, n) = -pushed;
  return all;
}

Eigen::MatrixXd BodyImpact::followed_compliance() const {
  const Eigen::Index n = compliance.rows(), m = sides[1].mode_compliance.size();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + m, n + m);
  all.topLeftCorner(n, n) = compliance;
  all.diagonal().tail(m) = sides[1].mode_compliance;
  return all;
}

void BodyImpact::keep(const std::vector<int>& kept) {
  std::vector<ImpactPlace> fewer;
  for (const int k : kept) fewer.push_back(places[static_cast<std::size_t>(k)]);
  places = std::move(fewer);
  for (ImpactSide& side : sides) {
    std::vector<std::int64_t> tags;
    for (const int k : kept) tags.push_back(side.tags[static_cast<std::size_t>(k)]);
    side.tags = std::move(tags);
    for (auto& [joint, columns] : side.flexibility.demands)
      columns = Eigen::Matrix<double, 6, Eigen::Dynamic>(columns(Eigen::all, kept));
    if (!side.held) continue;
    StandingFrame::HeldResponse& own = side.response;
    own.mobility = Eigen::MatrixXd(own.mobility(kept, kept));
    own.pushed = Eigen::MatrixXd(own.pushed(Eigen::all, kept));
    own.speed = Eigen::VectorXd(own.speed(kept));
    std::vector<std::vector<std::pair<NodeId, Vec6>>> at_nodes;
    for (const int k : kept) at_nodes.push_back(own.at_nodes[static_cast<std::size_t>(k)]);
    own.at_nodes = std::move(at_nodes);
  }
  compliance = Eigen::MatrixXd(compliance(kept, kept));
}

/// To both sides at once, opposite and equal.
void BodyImpact::give(const Eigen::VectorXd& impulses) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3 impulse = impulses(static_cast<Eigen::Index>(i)) * places[i].normal;
    sides[0].motion.push(-impulse, places[i].point);
    sides[1].motion.push(impulse, places[i].point);
  }
}

/// Of the modes of the struck nodes that the push moves: coordinates, or their rates.
Eigen::VectorXd carried_over(const ImpactSide& before, const Eigen::VectorXd& moved, const ImpactSide& now) {
  Eigen::VectorXd from = Eigen::VectorXd::Zero(before.response.squared.size()),
                  to = Eigen::VectorXd::Zero(now.response.squared.size());
  from(before.modes) = moved;
  Eigen::Index from_row = 0;
  for (const auto& [component, modes] : before.response.local) {
    Eigen::Index to_row = 0;
    for (const auto& [same, changed] : now.response.local) {
      if (same == component)
        to.segment(to_row, changed.squared.size()) =
            solver::carried_over(modes, from.segment(from_row, modes.squared.size()), changed);
      to_row += changed.squared.size();
    }
    from_row += modes.squared.size();
  }
  return to(now.modes);
}

}  // namespace topple::structure
