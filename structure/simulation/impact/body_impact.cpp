#include "simulation/impact/body_impact.h"

#include <algorithm>
#include <cmath>

#include "simulation/impact/impact_settings.h"

namespace topple::structure {

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
  const auto demands_of = [&](JointId joint) {
    const auto same = [joint](const auto& one) { return one.first == joint; };
    const auto found = std::find_if(response.node_demands.begin(), response.node_demands.end(), same);
    return found == response.node_demands.end() ? nullptr : &found->second;
  };
  // What a hinge does to the modes of unit modal mass as it turns is what they do to its moment.
  const auto by_hinge = [&](const StandingFrame::HeldResponse::Hinge& hinge, Eigen::Index mode) {
    const auto* by_mode = demands_of(hinge.joint);
    return by_mode ? (*by_mode)(hinge.axis, mode) : 0.0;
  };
  const auto reached = [&](Eigen::Index mode) {
    constexpr double none = 1e-9;
    for (Eigen::Index i = 0; i < local.size(); ++i)
      if (std::pow(response.pushed(mode, i), 2) > none * local(i)) return true;
    return std::any_of(response.hinges.begin(), response.hinges.end(), [&](const auto& hinge) {
      return std::pow(by_hinge(hinge, mode), 2) > none * hinge.stiffness * response.squared(mode);
    });
  };
  const auto hinges = static_cast<Eigen::Index>(response.hinges.size());
  side.hinge_demands.assign(side.flexibility.demands.size(), Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, hinges));
  const auto hinges_move = [&](Eigen::Index mode, double squared) {
    for (std::size_t k = 0; hinges > 0 && k < side.hinge_demands.size(); ++k)
      if (const auto* by_mode = demands_of(side.flexibility.demands[k].first))
        for (Eigen::Index h = 0; h < hinges; ++h)
          side.hinge_demands[k].col(h) +=
              by_mode->col(mode) * (by_hinge(response.hinges[static_cast<std::size_t>(h)], mode) / squared);
  };
  for (std::size_t k = 0; k < side.hinge_demands.size(); ++k)
    for (Eigen::Index h = 0; h < hinges; ++h)
      for (const auto& [joint, demand] : response.hinges[static_cast<std::size_t>(h)].demands)
        if (joint == side.flexibility.demands[k].first) side.hinge_demands[k].col(h) = demand;
  side.modes.clear();
  std::vector<double> give;
  for (Eigen::Index mode = 0; mode < response.squared.size(); ++mode) {
    if (!reached(mode)) continue;
    const double squared = response.squared(mode);
    if (squared <= fast * fast) {
      side.modes.push_back(static_cast<int>(mode));
      give.push_back(1 / std::max(squared, slow * slow));
      hinges_move(mode, std::max(squared, slow * slow));
      continue;
    }
    const Eigen::RowVectorXd moved = response.pushed.row(mode) / squared;
    compliance += response.pushed.row(mode).transpose() * moved;
    for (auto& [joint, columns] : side.flexibility.demands)
      if (const auto* by_mode = demands_of(joint)) columns += by_mode->col(mode) * moved;
    hinges_move(mode, squared);
  }
  side.mode_compliance = Eigen::Map<const Eigen::VectorXd>(give.data(), static_cast<Eigen::Index>(give.size()));
  side.mode_demands.clear();
  for (const auto& [joint, columns] : side.flexibility.demands) {
    const auto* by_mode = demands_of(joint);
    side.mode_demands.emplace_back(
        by_mode ? Eigen::Matrix<double, 6, Eigen::Dynamic>((*by_mode)(Eigen::all, side.modes) *
                                                           side.mode_compliance.asDiagonal())
                : Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, side.mode_compliance.size()));
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
