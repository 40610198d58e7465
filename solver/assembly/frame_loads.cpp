#include "assembly/frame_loads.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <stdexcept>

#include "elements/beam_unit_loads.h"

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

/// Displacements of held freedoms. A diaphragm's held freedoms follow from those of its nodes; what a rigid floor
/// cannot follow is an std::invalid_argument.
Eigen::VectorXd held_displacements(const FrameSystem& system, std::span<const Settlement> settlements) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(system.dofs().held);
  if (settlements.empty()) return result;
  std::vector<Vec6> imposed(system.model.nodes.size(), Vec6::Zero());
  for (const Settlement& s : settlements) {
    check_index(s.node, system.model.nodes.size(), "node");
    const auto n = static_cast<std::size_t>(s.node);
    if (s.component < 0 || s.component > 5 || !std::isinf(system.support_at(n)(s.component))) {
      throw std::invalid_argument("settlement of node " + std::to_string(s.node) + ": component " +
                                  std::to_string(s.component) + " is not held by a support");
    }
    imposed[n](s.component) += s.value;
    const bool shared = system.dofs().diaphragm_of_node[n] >= 0 && (s.component < 2 || s.component == 5);
    if (!shared)
      result(system.dofs().number[n][static_cast<std::size_t>(s.component)] - system.dofs().equations) += s.value;
  }
  for (std::size_t d = 0; d < system.model.diaphragms.size(); ++d) {
    std::vector<Eigen::Vector4d> rows;  // coefficients of x, y, rz of the reference point, and the value
    for (int node : system.model.diaphragms[d].nodes) {
      const auto n = static_cast<std::size_t>(node);
      if (std::isinf(system.support_at(n)(0))) rows.emplace_back(1, 0, -system.dofs().arm[n][1], imposed[n](0));
      if (std::isinf(system.support_at(n)(1))) rows.emplace_back(0, 1, system.dofs().arm[n][0], imposed[n](1));
      if (std::isinf(system.support_at(n)(5))) rows.emplace_back(0, 0, 1, imposed[n](5));
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
      const int number = system.dofs().diaphragm_number[d][c];
      if (number >= system.dofs().equations)
        result(number - system.dofs().equations) = motion(static_cast<Eigen::Index>(c));
    }
  }
  return result;
}

/// The reverse of a beam's fixed-end forces.
void add_fixed_end(const FrameSystem& system, int index, const Vec12& fixed_end, Eigen::VectorXd& force) {
  const Beam& beam = system.model.beams[static_cast<std::size_t>(index)];
  const Vec12 at_nodes = node_forces(beam, fixed_end);
  system.dofs().add_node_force(beam.node[0], -at_nodes.head<6>(), force.data());
  system.dofs().add_node_force(beam.node[1], -at_nodes.tail<6>(), force.data());
}

/// Energies, norms and stiffnesses under load multiply loads and displacements with each other.
void require_computable(const Eigen::VectorXd& force) {
  constexpr double most = 1e100;
  if (!force.allFinite()) throw std::invalid_argument("a load is not finite");
  if (force.size() > 0 && force.cwiseAbs().maxCoeff() > most)
    throw std::invalid_argument(
        "a load, or what a settlement or a temperature amounts to, is too large to compute with; accepted: at most "
        "1e100 N or N m");
}

void add_node_loads(const FrameSystem& system, const std::vector<NodeLoad>& loads, LoadVector& result) {
  if (!loads.empty()) result.node_load.assign(system.model.nodes.size(), Vec6::Zero());
  for (const NodeLoad& load : loads) {
    check_index(load.node, system.model.nodes.size(), "node");
    const auto n = static_cast<std::size_t>(load.node);
    if (system.node_stands[n] == 0) continue;
    result.node_load[n] += load.load;
    system.dofs().add_node_force(load.node, load.load, result.force.data());
  }
}

/// Beam by beam, so that each is condensed once for all sets.
void add_beam_loads(const FrameSystem& system, std::span<const LoadSet> sets, std::vector<LoadVector>& result) {
  const std::size_t beams = system.model.beams.size();
  std::deque<LoadsByBeam> by_beam;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    by_beam.emplace_back(beams, sets[k].beams);
    if (!sets[k].beams.empty()) result[k].beam_fixed_end.assign(beams, Vec12::Zero());
  }
  for (std::size_t i = 0; i < beams; ++i) {
    if (system.beam_stands[i] == 0) continue;
    std::optional<CondensedBeam> condensed;
    std::optional<BeamUnitLoads> units;
    for (std::size_t k = 0; k < sets.size(); ++k) {
      const std::span<const BeamLoad> loads = by_beam[k].on(i);
      if (loads.empty()) continue;
      if (!condensed && system.second_order == nullptr) {
        condensed.emplace(system.model.beams[i], system.beam_factor[i]);
        if (sets.size() >= worth_unit_loads && BeamUnitLoads::apply_to(system.model.beams[i]))
          units.emplace(*condensed);
      }
      const int beam = static_cast<int>(i);
      FixedEndForces fixed;
      if (units) {
        fixed.force = units->fixed_end_forces(loads);
      } else {
        fixed = condensed ? condensed->fixed_end_forces(loads) : system.fixed_end_forces(beam, loads);
      }
      if (fixed.unbalanced > 0) result[k].unbalanced_beams.push_back(beam);
      result[k].beam_fixed_end[i] = fixed.force;
      add_fixed_end(system, beam, fixed.force, result[k].force);
    }
  }
}

void add_shell_loads(const FrameSystem& system, const std::vector<ShellLoad>& loads, LoadVector& result) {
  result.shell_fixed.assign(system.model.shells.size(), Vec24::Zero());
  for (const ShellLoad& load : loads) {
    check_index(load.shell, system.model.shells.size(), "shell");
    const auto i = static_cast<std::size_t>(load.shell);
    if (system.shell_stands[i] == 0) continue;
    const Shell& shell = system.model.shells[i];
    const auto given = system.model.shell_stiffness.find(load.shell);
    const Vec24 fixed =
        given != system.model.shell_stiffness.end()
            ? fixed_forces_of_given(given->second, load, corner_places(shell, system.model.nodes))
            : ShellElement(shell, corner_places(shell, system.model.nodes)).fixed_forces(load.traction, load.strain);
    result.shell_fixed[i] += fixed;
    for (int n = 0; n < 4; ++n) {
      system.dofs().add_node_force(shell.node[static_cast<std::size_t>(n)], -fixed.segment<6>(6 * n),
                                   result.force.data());
    }
  }
}

/// What elements with imposed displacements at their held freedoms do to the others.
void add_settlement_forces(const FrameSystem& system, LoadVector& result) {
  const std::size_t beams = system.model.beams.size();
  for (std::size_t element = 0; element < system.element_of_patch(0) + system.model.patches.size(); ++element) {
    const auto freedoms = system.assembly_map().freedoms(element);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(freedoms.size()));
    for (std::size_t k = 0; k < freedoms.size(); ++k) {
      if (freedoms[k] < system.dofs().equations) continue;
      u(static_cast<Eigen::Index>(k)) = result.held_displacement(freedoms[k] - system.dofs().equations);
    }
    if ((u.array() == 0).all()) continue;
    Eigen::VectorXd force(u.size());
    if (element < beams) {
      force = system.beam_stiffness(static_cast<int>(element)) * u;
    } else {
      force = system.plate_stiffness(element) * u;
    }
    for (std::size_t k = 0; k < freedoms.size(); ++k) result.force(freedoms[k]) -= force(static_cast<Eigen::Index>(k));
  }
}

}  // namespace

LoadVector load_vector(const FrameSystem& system, const LoadSet& loads) {
  return std::move(load_vectors(system, {&loads, 1}).front());
}

std::vector<LoadVector> load_vectors(const FrameSystem& system, std::span<const LoadSet> sets) {
  std::vector<LoadVector> result(sets.size());
  for (std::size_t k = 0; k < sets.size(); ++k) {
    result[k].force = Eigen::VectorXd::Zero(system.dofs().equations + system.dofs().held);
    add_node_loads(system, sets[k].nodes, result[k]);
  }
  add_beam_loads(system, sets, result);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    LoadVector& vector = result[k];
    if (!sets[k].shells.empty()) add_shell_loads(system, sets[k].shells, vector);
    vector.held_displacement = held_displacements(system, sets[k].settlements);
    if (!(vector.held_displacement.array() == 0).all()) add_settlement_forces(system, vector);
    require_computable(vector.force);
  }
  return result;
}

}  // namespace topple::solver
