#include "mesh/semi_rigid_elements.h"

#include <algorithm>

#include "topple/solver/superelement.h"

namespace topple::structure {

std::pair<std::vector<int>, Eigen::MatrixXd> corners_by_freedoms(const Frame& frame, const SemiRigidElement& element) {
  const auto& rigid_ends = frame.model.shells[static_cast<std::size_t>(element.shell)].node;
  std::vector<int> nodes(rigid_ends.begin(), rigid_ends.end());
  Eigen::MatrixXd from = Eigen::MatrixXd::Identity(24, 24);
  for (std::size_t c = 0; c < 4; ++c) {
    if (element.semi_rigid_node[c] < 0) continue;
    const SemiRigidNode& semi_rigid = frame.semi_rigid_nodes[static_cast<std::size_t>(element.semi_rigid_node[c])];
    nodes.push_back(semi_rigid.node);
    from.conservativeResize(24, from.cols() + 6);
    from.rightCols<6>().setZero();
    const auto row = static_cast<Eigen::Index>(6 * c);
    from.block<3, 3>(row, from.cols() - 6) = semi_rigid.translations;
    from.block<3, 3>(row + 3, from.cols() - 3) = semi_rigid.rotations;
  }
  return {std::move(nodes), std::move(from)};
}

const SemiRigidElement* semi_rigid_element(const Frame& frame, int shell) {
  const auto& all = frame.semi_rigid_elements;
  const auto found = std::lower_bound(all.begin(), all.end(), shell, [](const SemiRigidElement& element, int number) {
    return element.shell < number;
  });
  return found != all.end() && found->shell == shell ? &*found : nullptr;
}

std::vector<solver::JointedShell> jointed_shells(const Frame& frame) {
  std::vector<solver::JointedShell> all;
  int patch = 0;
  for (const SemiRigidElement& element : frame.semi_rigid_elements) {
    // The patches of elements come in their order, with those of springs between them.
    auto [nodes, corners] = corners_by_freedoms(frame, element);
    while (frame.model.patches[static_cast<std::size_t>(patch)].node != nodes) ++patch;
    all.push_back({element.shell, patch, std::move(corners)});
  }
  return all;
}

void make_absolute(const Frame& frame, std::vector<Vec6>& displacements) {
  for (const SemiRigidNode& semi_rigid : frame.semi_rigid_nodes) {
    Vec6& own = displacements[static_cast<std::size_t>(semi_rigid.node)];
    const Vec6& rigid_end = displacements[static_cast<std::size_t>(semi_rigid.rigid_end)];
    own = (Vec6() << rigid_end.head<3>() + semi_rigid.translations * own.head<3>(),
           rigid_end.tail<3>() + semi_rigid.rotations * own.tail<3>())
              .finished();
  }
}

void make_shape_absolute(const Frame& frame, std::vector<Vec6>& shape) {
  if (frame.semi_rigid_nodes.empty()) return;
  make_absolute(frame, shape);
  double largest = 0;
  for (const Vec6& moved : shape) largest = std::max(largest, moved.head<3>().norm());
  constexpr double turns_only = 1e-6;  // of a shape whose largest rotation is 1
  if (largest < turns_only) return;
  for (Vec6& moved : shape) moved /= largest;
}

namespace {

/// Forces that do the work of a traction and a free strain at an element's corners.
std::array<Vec6, 4> corner_loads(const Frame& frame, const SemiRigidElement& element, const Vec3& traction,
                                 double strain) {
  std::array<Vec6, 4> loads;
  loads.fill(Vec6::Zero());
  const auto& nodes = frame.model.shells[static_cast<std::size_t>(element.shell)].node;
  if (!traction.isZero(0)) loads = solver::traction_loads(frame.model, element.shell, traction);
  if (strain == 0) return loads;
  Eigen::Matrix<double, 24, 1> swollen = Eigen::Matrix<double, 24, 1>::Zero();
  const Vec3 origin = frame.model.nodes[static_cast<std::size_t>(nodes[0])];
  for (int c = 1; c < 4; ++c)
    swollen.segment<3>(6 * c) =
        strain * (frame.model.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(c)])] - origin);
  const Eigen::Matrix<double, 24, 1> force = element.stiffness * swollen;
  for (int c = 0; c < 4; ++c) loads[static_cast<std::size_t>(c)] += force.segment<6>(6 * c);
  return loads;
}

}  // namespace

void add_element_loads(const Frame& frame, const SemiRigidElement& element, const Vec3& traction, double strain,
                       solver::LoadSet& set) {
  const auto loads = corner_loads(frame, element, traction, strain);
  const auto& nodes = frame.model.shells[static_cast<std::size_t>(element.shell)].node;
  for (std::size_t c = 0; c < 4; ++c) {
    set.nodes.push_back({nodes[c], loads[c]});
    if (element.semi_rigid_node[c] < 0) continue;
    const SemiRigidNode& semi_rigid = frame.semi_rigid_nodes[static_cast<std::size_t>(element.semi_rigid_node[c])];
    Vec6 own;
    own << semi_rigid.translations.transpose() * loads[c].head<3>(),
        semi_rigid.rotations.transpose() * loads[c].tail<3>();
    set.nodes.push_back({semi_rigid.node, own});
  }
  // The strain itself is told for what second order makes of it.
  if (strain != 0) set.shells.push_back({element.shell, Vec3::Zero(), strain});
}

std::array<Vec6, 4> element_corner_forces(const Frame& frame, const SemiRigidElement& element,
                                          const solver::StaticSolution& solution, const Vec3& traction, double strain) {
  const auto& nodes = frame.model.shells[static_cast<std::size_t>(element.shell)].node;
  Eigen::Matrix<double, 24, 1> u;
  for (std::size_t c = 0; c < 4; ++c) {
    const int node = element.semi_rigid_node[c] < 0
                         ? nodes[c]
                         : frame.semi_rigid_nodes[static_cast<std::size_t>(element.semi_rigid_node[c])].node;
    u.segment<6>(static_cast<Eigen::Index>(6 * c)) = solution.displacements[static_cast<std::size_t>(node)];
  }
  const Eigen::Matrix<double, 24, 1> force = element.stiffness * u;
  const auto loads = corner_loads(frame, element, traction, strain);
  // What the solver knows of the shell is what its membrane forces do to the displaced corners.
  std::array<Vec6, 4> result = solution.shell_corner_forces[static_cast<std::size_t>(element.shell)];
  for (std::size_t c = 0; c < 4; ++c) result[c] += force.segment<6>(static_cast<Eigen::Index>(6 * c)) - loads[c];
  return result;
}

void leave_out_semi_rigid_sides(const Frame& frame, solver::LoadSet& loads, std::vector<Vec6>& reactions) {
  if (frame.semi_rigid_nodes.empty()) return;
  const int first = frame.semi_rigid_nodes.front().node;
  std::erase_if(loads.nodes, [&](const solver::NodeLoad& load) { return load.node >= first; });
  reactions.resize(reactions.size() - frame.semi_rigid_nodes.size());
}

}  // namespace topple::structure
