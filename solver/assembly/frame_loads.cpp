// Right-hand sides of a frame: loads on nodes and beams, imposed displacements.
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <stdexcept>

#include "assembly/frame_system.h"
#include "elements/beam_unit_loads.h"
#include "elements/second_order_beam.h"

namespace topple::solver {
namespace {

void check_index(int index, std::size_t count, const char* what) {
  if (index < 0 || static_cast<std::size_t>(index) >= count) {
    throw std::invalid_argument(std::string("load on ") + what + " " + std::to_string(index) +
                                ", which does not exist");
  }
}

/// Sets of loads from which on those of unit loads are worth the trouble.
constexpr std::size_t worth_unit_loads = 3;

/// The loads of each beam together: those of the set itself where they lie in order of the beams.
class LoadsByBeam {
 public:
  LoadsByBeam(std::size_t beams, const std::vector<BeamLoad>& loads) : start_(beams + 1, 0), loads_(&loads) {
    for (const BeamLoad& load : loads) {
      check_index(load.beam, beams, "beam");
      ++start_[static_cast<std::size_t>(load.beam) + 1];
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    const auto before = [](const BeamLoad& a, const BeamLoad& b) { return a.beam < b.beam; };
    if (std::is_sorted(loads.begin(), loads.end(), before)) return;
    sorted_ = loads;
    std::stable_sort(sorted_.begin(), sorted_.end(), before);
    loads_ = &sorted_;
  }
  LoadsByBeam(LoadsByBeam&&) = delete;

  [[nodiscard]] std::span<const BeamLoad> on(std::size_t beam) const {
    return {loads_->data() + start_[beam], start_[beam + 1] - start_[beam]};
  }

 private:
  std::vector<std::size_t> start_;
  std::vector<BeamLoad> sorted_;
  const std::vector<BeamLoad>* loads_;
};

/// Of a stiffness that comes from elsewhere: what keeps it from swelling evenly.
Vec24 fixed_forces_of_given(const Mat24& stiffness, const ShellLoad& load, const std::array<Vec3, 4>& corners) {
  if (!load.traction.isZero(0))
    throw std::invalid_argument("a traction on shell " + std::to_string(load.shell) +
                                ", whose stiffness is given; accepted: forces on its nodes");
  Vec24 free = Vec24::Zero();
  for (int n = 1; n < 4; ++n)
    free.segment<3>(6 * n) = load.strain * (corners[static_cast<std::size_t>(n)] - corners[0]);
  return -stiffness * free;
}

}  // namespace

/// Displacements of held freedoms. A diaphragm's held freedoms follow from those of its nodes; what a rigid floor
/// cannot follow is an std::invalid_argument.
Eigen::VectorXd FrameSystem::held_displacements(std::span<const Settlement> settlements) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(dofs_.held);
  if (settlements.empty()) return result;
  std::vector<Vec6> imposed(model.nodes.size(), Vec6::Zero());
  for (const Settlement& s : settlements) {
    check_index(s.node, model.nodes.size(), "node");
    const auto n = static_cast<std::size_t>(s.node);
    if (s.component < 0 || s.component > 5 || !std::isinf(support_[n](s.component))) {
      throw std::invalid_argument("settlement of node " + std::to_string(s.node) + ": component " +
                                  std::to_string(s.component) + " is not held by a support");
    }
    imposed[n](s.component) += s.value;
    const bool shared = dofs_.diaphragm_of_node[n] >= 0 && (s.component < 2 || s.component == 5);
    if (!shared) result(dofs_.number[n][static_cast<std::size_t>(s.component)] - dofs_.equations) += s.value;
  }
  for (std::size_t d = 0; d < model.diaphragms.size(); ++d) {
    std::vector<Eigen::Vector4d> rows;  // coefficients of x, y, rz of the reference point, and the value
    for (int node : model.diaphragms[d].nodes) {
      const auto n = static_cast<std::size_t>(node);
      if (std::isinf(support_[n](0))) rows.emplace_back(1, 0, -dofs_.arm[n][1], imposed[n](0));
      if (std::isinf(support_[n](1))) rows.emplace_back(0, 1, dofs_.arm[n][0], imposed[n](1));
      if (std::isinf(support_[n](5))) rows.emplace_back(0, 0, 1, imposed[n](5));
    }
    if (rows.empty()) continue;
    Eigen::MatrixXd A(rows.size(), 3);
    Eigen::VectorXd b(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      A.row(static_cast<Eigen::Index>(i)) = rows[i].head<3>();
      b(static_cast<Eigen::Index>(i)) = rows[i](3);
    }
    const Eigen::Vector3d motion = A.completeOrthogonalDecomposition().solve(b);
    constexpr double consistent = 1e-9;
    if ((A * motion - b).cwiseAbs().maxCoeff() > consistent * b.cwiseAbs().maxCoeff()) {
      throw std::invalid_argument("settlements bend diaphragm " + std::to_string(d) + ", which is rigid in its plane");
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const int number = dofs_.diaphragm_number[d][c];
      if (number >= dofs_.equations) result(number - dofs_.equations) = motion(static_cast<Eigen::Index>(c));
    }
  }
  return result;
}

FixedEndForces FrameSystem::fixed_end_forces(int beam, std::span<const BeamLoad> loads) const {
  const auto i = static_cast<std::size_t>(beam);
  if (beam_stands[i] == 0) return {};
  if (second_order != nullptr)
    return SecondOrderBeam(model.beams[i], beam_factor[i], second_order->mode, second_order->first_axial[i], loads)
        .fixed_end_forces();
  return CondensedBeam(model.beams[i], beam_factor[i]).fixed_end_forces(loads);
}

void FrameSystem::add_fixed_end(int index, const Vec12& fixed_end, Eigen::VectorXd& force) const {
  const Beam& beam = model.beams[static_cast<std::size_t>(index)];
  const Vec12 at_nodes = node_forces(beam, fixed_end);
  dofs_.add_node_force(beam.node[0], -at_nodes.head<6>(), force.data());
  dofs_.add_node_force(beam.node[1], -at_nodes.tail<6>(), force.data());
}

LoadVector FrameSystem::load_vector(const LoadSet& loads) const { return std::move(load_vectors({&loads, 1}).front()); }

namespace {

/// Energies, norms and stiffnesses under load multiply loads and displacements with each other.
void require_computable(const Eigen::VectorXd& force) {
  constexpr double most = 1e100;
  if (!force.allFinite()) throw std::invalid_argument("a load is not finite");
  if (force.size() > 0 && force.cwiseAbs().maxCoeff() > most)
    throw std::invalid_argument(
        "a load, or what a settlement or a temperature amounts to, is too large to compute with; accepted: at most "
        "1e100 N or N m");
}

}  // namespace

std::vector<LoadVector> FrameSystem::load_vectors(std::span<const LoadSet> sets) const {
  std::vector<LoadVector> result(sets.size());
  for (std::size_t k = 0; k < sets.size(); ++k) {
    result[k].force = Eigen::VectorXd::Zero(dofs_.equations + dofs_.held);
    add_node_loads(sets[k].nodes, result[k]);
  }
  add_beam_loads(sets, result);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    LoadVector& vector = result[k];
    if (!sets[k].shells.empty()) add_shell_loads(sets[k].shells, vector);
    vector.held_displacement = held_displacements(sets[k].settlements);
    if (!(vector.held_displacement.array() == 0).all()) add_settlement_forces(vector);
    require_computable(vector.force);
  }
  return result;
}

void FrameSystem::add_node_loads(const std::vector<NodeLoad>& loads, LoadVector& result) const {
  if (!loads.empty()) result.node_load.assign(model.nodes.size(), Vec6::Zero());
  for (const NodeLoad& load : loads) {
    check_index(load.node, model.nodes.size(), "node");
    const auto n = static_cast<std::size_t>(load.node);
    if (node_stands[n] == 0) continue;
    result.node_load[n] += load.load;
    dofs_.add_node_force(load.node, load.load, result.force.data());
  }
}

/// Beam by beam, so that each is condensed once for all sets.
void FrameSystem::add_beam_loads(std::span<const LoadSet> sets, std::vector<LoadVector>& result) const {
  const std::size_t beams = model.beams.size();
  std::deque<LoadsByBeam> by_beam;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    by_beam.emplace_back(beams, sets[k].beams);
    if (!sets[k].beams.empty()) result[k].beam_fixed_end.assign(beams, Vec12::Zero());
  }
  for (std::size_t i = 0; i < beams; ++i) {
    if (beam_stands[i] == 0) continue;
    std::optional<CondensedBeam> condensed;
    std::optional<BeamUnitLoads> units;
    for (std::size_t k = 0; k < sets.size(); ++k) {
      const std::span<const BeamLoad> loads = by_beam[k].on(i);
      if (loads.empty()) continue;
      if (!condensed && second_order == nullptr) {
        condensed.emplace(model.beams[i], beam_factor[i]);
        if (sets.size() >= worth_unit_loads && BeamUnitLoads::apply_to(model.beams[i])) units.emplace(*condensed);
      }
      const int beam = static_cast<int>(i);
      FixedEndForces fixed;
      if (units) {
        fixed.force = units->fixed_end_forces(loads);
      } else {
        fixed = condensed ? condensed->fixed_end_forces(loads) : fixed_end_forces(beam, loads);
      }
      if (fixed.unbalanced > 0) result[k].unbalanced_beams.push_back(beam);
      result[k].beam_fixed_end[i] = fixed.force;
      add_fixed_end(beam, fixed.force, result[k].force);
    }
  }
}

void FrameSystem::add_shell_loads(const std::vector<ShellLoad>& loads, LoadVector& result) const {
  result.shell_fixed.assign(model.shells.size(), Vec24::Zero());
  for (const ShellLoad& load : loads) {
    check_index(load.shell, model.shells.size(), "shell");
    const auto i = static_cast<std::size_t>(load.shell);
    if (shell_stands[i] == 0) continue;
    const Shell& shell = model.shells[i];
    const auto given = model.shell_stiffness.find(load.shell);
    const Vec24 fixed =
        given != model.shell_stiffness.end()
            ? fixed_forces_of_given(given->second, load, corner_places(shell, model.nodes))
            : ShellElement(shell, corner_places(shell, model.nodes)).fixed_forces(load.traction, load.strain);
    result.shell_fixed[i] += fixed;
    for (int n = 0; n < 4; ++n) {
      dofs_.add_node_force(shell.node[static_cast<std::size_t>(n)], -fixed.segment<6>(6 * n), result.force.data());
    }
  }
}

/// What elements with imposed displacements at their held freedoms do to the others.
void FrameSystem::add_settlement_forces(LoadVector& result) const {
  const std::size_t beams = model.beams.size();
  for (std::size_t element = 0; element < element_of_patch(0) + model.patches.size(); ++element) {
    const auto freedoms = assembly_map_.freedoms(element);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(freedoms.size()));
    for (std::size_t k = 0; k < freedoms.size(); ++k) {
      if (freedoms[k] < dofs_.equations) continue;
      u(static_cast<Eigen::Index>(k)) = result.held_displacement(freedoms[k] - dofs_.equations);
    }
    if ((u.array() == 0).all()) continue;
    Eigen::VectorXd force(u.size());
    if (element < beams) {
      force = beam_stiffness(static_cast<int>(element)) * u;
    } else {
      force = plate_stiffness(element) * u;
    }
    for (std::size_t k = 0; k < freedoms.size(); ++k) result.force(freedoms[k]) -= force(static_cast<Eigen::Index>(k));
  }
}

std::optional<Defect> FrameSystem::unbalanced_load(const LoadVector& load, double lever_share) const {
  const std::vector<InertNode>& inert = inert_[static_cast<std::size_t>(Motion::rotation)];
  if (load.unbalanced_beams.empty() && inert_nodes_[static_cast<std::size_t>(Motion::rotation)] == 0)
    return std::nullopt;
  Defect result;
  result.motion.motion.assign(model.nodes.size(), Vec6::Zero());
  if (!load.unbalanced_beams.empty()) {
    result.motion.beams = load.unbalanced_beams;
    result.message = "unstable: beam " + std::to_string(load.unbalanced_beams[0]) +
                     " is loaded in a direction in which the releases at its ends let it move";
    return result;
  }
  double largest = 0, lever_moment = 0;
  const auto moment_at = [&](std::size_t node) {
    Vec3 m = Vec3::Zero();
    for (std::size_t c = 3; c < 6; ++c) {
      const int e = dofs_.number[node][c];
      if (e < dofs_.equations) m(static_cast<Eigen::Index>(c) - 3) = load.force(e);
    }
    return m;
  };
  for (std::size_t node = 0; node < inert.size(); ++node) largest = std::max(largest, moment_at(node).norm());
  if (lever_share > 0) {
    double longest = 0, force = 0;
    for (const Beam& beam : model.beams) longest = std::max(longest, beam.length);
    for (const auto& numbers : dofs_.number)
      for (std::size_t c = 0; c < 3; ++c)
        if (numbers[c] < dofs_.equations) force = std::max(force, std::abs(load.force(numbers[c])));
    lever_moment = lever_share * longest * force;
  }
  constexpr double rounding = 1e-10;  // of the largest moment on any node
  const double nothing = std::max(rounding * largest, lever_moment);
  for (std::size_t node = 0; node < inert.size(); ++node) {
    for (int k = 0; k < inert[node].count; ++k) {
      const Vec3 axis = inert[node].directions.col(k);
      if (std::abs(axis.dot(moment_at(node))) <= nothing) continue;
      result.motion.nodes.push_back(static_cast<int>(node));
      result.motion.motion[node].tail<3>() = axis;
    }
  }
  if (result.motion.nodes.empty()) return std::nullopt;
  result.message =
      "unstable: a moment acts on " + list_nodes(result.motion.nodes) + ", and nothing there resists turning";
  return result;
}

void FrameSystem::drop_idle(Motion kind, std::size_t node, std::span<const double> scale,
                            Eigen::VectorXd& values) const {
  const auto k = static_cast<std::size_t>(kind);
  const InertNode& inert = inert_[k][node];
  for (int i = 0; i < inert.count; ++i) {
    const Vec3 axis = inert.directions.col(i);
    double idle = 0;
    for (std::size_t c = 0; c < 3; ++c)
      if (const int e = dofs_.number[node][3 * k + c]; e < dofs_.equations)
        idle +=
            axis(static_cast<Eigen::Index>(c)) * values(e) * (scale.empty() ? 1 : scale[static_cast<std::size_t>(e)]);
    for (std::size_t c = 0; c < 3; ++c)
      if (const int e = dofs_.number[node][3 * k + c]; e < dofs_.equations)
        values(e) -=
            idle * axis(static_cast<Eigen::Index>(c)) / (scale.empty() ? 1 : scale[static_cast<std::size_t>(e)]);
  }
}

void FrameSystem::drop_idle_loads(LoadVector& load) const {
  for (const Motion kind : {Motion::translation, Motion::rotation}) {
    const auto k = static_cast<std::size_t>(kind);
    if (inert_nodes_[k] == 0) continue;
    for (std::size_t node = 0; node < inert_[k].size(); ++node) drop_idle(kind, node, {}, load.force);
  }
}

void FrameSystem::drop_idle_motion(Eigen::VectorXd& scaled) const {
  for (const Motion kind : {Motion::translation, Motion::rotation}) {
    const auto k = static_cast<std::size_t>(kind);
    if (inert_nodes_[k] == 0) continue;
    for (std::size_t node = 0; node < inert_[k].size(); ++node) drop_idle(kind, node, scale_, scaled);
  }
}

}  // namespace topple::solver
