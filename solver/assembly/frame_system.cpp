#include "assembly/frame_system.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "elements/second_order_beam.h"
#include "factor/ordering.h"
#include "topple/solver/parallel_for.h"

namespace topple::solver {
namespace {

AssemblyMap make_assembly_map(const FrameModel& model, const DofMap& dofs) {
  std::vector<int> freedoms;
  std::vector<std::int64_t> start{0};
  const auto add = [&](std::span<const int> nodes) {
    for (int node : nodes) {
      const auto& numbers = dofs.number[static_cast<std::size_t>(node)];
      freedoms.insert(freedoms.end(), numbers.begin(), numbers.end());
    }
    start.push_back(static_cast<std::int64_t>(freedoms.size()));
  };
  for (const Beam& beam : model.beams) add(beam.node);
  for (const Shell& shell : model.shells) add(shell.node);
  for (const Patch& patch : model.patches) add(patch.node);
  // A node without elements still couples with its diaphragm; in one element of its own it keeps its place.
  for (const Diaphragm& diaphragm : model.diaphragms) {
    for (int node : diaphragm.nodes) add(std::span(&node, 1));
  }
  return {dofs, std::move(freedoms), std::move(start)};
}

}  // namespace

std::string list_nodes(std::span<const int> nodes) {
  constexpr std::size_t shown = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(nodes.size(), shown); ++i) {
    text += (i > 0 ? ", node " : "node ") + std::to_string(nodes[i]);
  }
  if (nodes.size() > shown) text += " and " + std::to_string(nodes.size() - shown) + " more";
  return text;
}

FrameSystem::FrameSystem(FrameModel given)
    : FrameElements(std::move(given)),
      support_(support_stiffness(model)),
      assembly_map_(make_assembly_map(model, dofs())),
      matrix_(assembly_map_.empty_matrix()),
      scale_(static_cast<std::size_t>(dofs().equations), 1.0),
      inert_(model.nodes.size()) {}

std::vector<int> FrameSystem::elimination_order() const {
  std::vector<int> active, index(static_cast<std::size_t>(dofs().vertices()), -1), freedoms;
  for (int v = 0; v < dofs().vertices(); ++v) {
    const auto n = static_cast<std::size_t>(v);
    if (dofs().first_equation[n + 1] == dofs().first_equation[n]) continue;
    index[n] = static_cast<int>(active.size());
    active.push_back(v);
    freedoms.push_back(dofs().first_equation[n + 1] - dofs().first_equation[n]);
  }
  std::vector<std::pair<int, int>> edges;
  edges.reserve(assembly_map_.edges().size());
  for (const auto& [v, w] : assembly_map_.edges()) {
    edges.emplace_back(index[static_cast<std::size_t>(v)], index[static_cast<std::size_t>(w)]);
  }
  std::vector<int> order;
  order.reserve(static_cast<std::size_t>(dofs().equations));
  for (int a : order_nodes(static_cast<int>(active.size()), edges, freedoms)) {
    const auto v = static_cast<std::size_t>(active[static_cast<std::size_t>(a)]);
    for (int e = dofs().first_equation[v]; e < dofs().first_equation[v + 1]; ++e) order.push_back(e);
  }
  return order;
}

void FrameSystem::add_element(std::size_t element, const std::vector<char>& wanted) {
  if (inertia != nullptr) add_element_mass(element, wanted);
  const std::size_t beams = model.beams.size();
  if (element < beams) {
    if (beam_stands[element] == 0) return;
    const Mat12 K = beam_stiffness(static_cast<int>(element));
    assembly_map_.add(element, K.data(), scale_, wanted, matrix_);
  } else if (element < beams + model.shells.size() && shell_stands[element - beams] != 0) {
    const Mat24 K = shell_stiffness(static_cast<int>(element - beams));
    assembly_map_.add(element, K.data(), scale_, wanted, matrix_);
  } else if (element >= element_of_patch(0) && element < element_of_patch(0) + model.patches.size()) {
    const Eigen::MatrixXd K = patch_stiffness(static_cast<int>(element - element_of_patch(0)));
    assembly_map_.add(element, K.data(), scale_, wanted, matrix_);
  }
}

double& FrameSystem::entry(int equation, int other) {
  return matrix_.value[static_cast<std::size_t>(assembly_map_.position(equation, other))];
}

/// A node turned about an axis that no element resists strains nothing, bears nothing and belongs to nobody: a node of
/// a truss. It is held at zero, in any direction in space; unbalanced_load() refuses a moment about it. Of a frame that
/// moves the same goes for a translation that has neither stiffness nor mass: what breaks may leave a node on nothing
/// but a membrane.
void FrameSystem::hold_inert_motions(int node, InertMotions::Kind kind) {
  constexpr double inert_limit = 1e-13;  // of the largest stiffness of its kind at the node: rounding of rotated zeros
  const auto n = static_cast<std::size_t>(node), k = static_cast<std::size_t>(kind);
  const bool in_diaphragm = dofs().diaphragm_of_node[n] >= 0;
  std::array<int, 3> component{}, equation{};
  std::size_t free = 0;
  for (int c = 0; c < 3; ++c) {
    const int e = dofs().number[n][3 * k + static_cast<std::size_t>(c)];
    if (e >= dofs().equations || (in_diaphragm && (c == 2) == (kind == InertMotions::Kind::rotation))) continue;
    component[free] = c;
    equation[free++] = e;
  }
  if (free == 0) return;
  Mat3 block = Mat3::Zero();
  for (std::size_t i = 0; i < free; ++i) {
    for (std::size_t j = 0; j < free; ++j) {
      block(component[i], component[j]) = entry(equation[i], equation[j]) /
                                          scale_[static_cast<std::size_t>(equation[i])] /
                                          scale_[static_cast<std::size_t>(equation[j])];
    }
  }
  for (int c = 0; c < 3; ++c) {  // held components are not looked for
    if (std::find(component.begin(), component.begin() + static_cast<std::ptrdiff_t>(free), c) ==
        component.begin() + static_cast<std::ptrdiff_t>(free)) {
      block(c, c) = std::numeric_limits<double>::infinity();
    }
  }
  double largest = 0;
  for (std::size_t i = 0; i < free; ++i) largest = std::max(largest, block(component[i], component[i]));
  const double held = largest > 0 ? largest : 1 / std::pow(scale_[static_cast<std::size_t>(equation[0])], 2);
  for (int c = 0; c < 3; ++c) {
    if (std::isinf(block(c, c))) block(c, c) = held;
  }
  // A cheap test first: the determinant of a well-braced node is far from zero.
  if (largest > 0 && block.determinant() > 1e-9 * held * held * held) return;
  const Eigen::SelfAdjointEigenSolver<Mat3> modes(block);
  for (int m = 0; m < 3; ++m) {
    if (std::abs(modes.eigenvalues()(m)) > inert_limit * held)
      continue;  // below zero: a softened node, not an inert one
    const Vec3 d = modes.eigenvectors().col(m);
    inert_.add(kind, n, d, held);
    for (std::size_t i = 0; i < free; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        entry(equation[i], equation[j]) += held * d(component[i]) * d(component[j]) *
                                           scale_[static_cast<std::size_t>(equation[i])] *
                                           scale_[static_cast<std::size_t>(equation[j])];
      }
    }
  }
}

void FrameSystem::finish_node(int node) {
  const auto n = static_cast<std::size_t>(node);
  if (node_stands[n] == 0) {
    for (int e = dofs().first_equation[n]; e < dofs().first_equation[n + 1]; ++e) entry(e, e) = 1;
    inert_.forget(n);
    return;
  }
  add_diagonal(node, own_springs(node), matrix_);
  if (inertia != nullptr) add_diagonal(node, inertia->at_node[n], mass_);
  inert_.forget(n);
  if (inertia != nullptr) hold_inert_motions(node, InertMotions::Kind::translation);
  hold_inert_motions(node, InertMotions::Kind::rotation);
}

/// A diaphragm whose nodes have all left is held.
void FrameSystem::finish_diaphragms(const std::vector<char>& wanted) {
  for (std::size_t d = 0; d < model.diaphragms.size(); ++d) {
    const std::size_t v = model.nodes.size() + d;
    if (!wanted.empty() && wanted[v] == 0) continue;
    const auto& nodes = model.diaphragms[d].nodes;
    if (std::any_of(nodes.begin(), nodes.end(), [&](int n) { return node_stands[static_cast<std::size_t>(n)] != 0; }))
      continue;
    for (int e = dofs().first_equation[v]; e < dofs().first_equation[v + 1]; ++e) entry(e, e) = 1;
  }
}

void FrameSystem::set_scale() {
  for (int e = 0; e < dofs().equations; ++e) {
    const double diagonal = entry(e, e);
    scale_[static_cast<std::size_t>(e)] = diagonal > 0 ? std::exp2(-std::round(std::log2(diagonal) / 2)) : 1.0;
  }
  for (int column = 0; column < dofs().equations; ++column) {
    const auto c = static_cast<std::size_t>(column);
    for (auto k = matrix_.start[c]; k < matrix_.start[c + 1]; ++k) {
      const auto i = static_cast<std::size_t>(k);
      matrix_.value[i] *= scale_[c] * scale_[static_cast<std::size_t>(matrix_.row[i])];
    }
  }
  scale_mass();
}

void FrameSystem::set_support(int support, const Vec6& stiffness) {
  model.supports[static_cast<std::size_t>(support)].stiffness = stiffness;
  support_ = support_stiffness(model);
}

/// Stiffnesses of second order are power series, and take longer to find than to add: those of many beams are found
/// side by side, then added in order.
void FrameSystem::add_beams(int threads) {
  constexpr std::size_t together = 8192, share = 512;
  const std::size_t beams = model.beams.size();
  if (threads <= 1 || second_order == nullptr || beams < 2 * share) {
    for (std::size_t i = 0; i < beams; ++i) add_element(i, {});
    return;
  }
  std::vector<Mat12> stiffness(std::min(beams, together));
  for (std::size_t first = 0; first < beams; first += together) {
    const std::size_t count = std::min(together, beams - first);
    parallel_for((count + share - 1) / share, threads, [&](std::size_t part) {
      const std::size_t from = part * share;
      for (std::size_t i = from; i < std::min(count, from + share); ++i)
        if (beam_stands[first + i] != 0) stiffness[i] = beam_stiffness(static_cast<int>(first + i));
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (inertia != nullptr) add_element_mass(first + i, {});
      if (beam_stands[first + i] != 0) assembly_map_.add(first + i, stiffness[i].data(), scale_, {}, matrix_);
    }
  }
}

void FrameSystem::assemble(int threads) {
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
  mass_ = inertia != nullptr ? assembly_map_.empty_matrix() : SparseSymmetric();
  std::fill(scale_.begin(), scale_.end(), 1.0);
  add_beams(threads);
  for (std::size_t i = model.beams.size(); i < element_of_patch(0) + model.patches.size(); ++i) add_element(i, {});
  for (std::size_t node = 0; node < model.nodes.size(); ++node) finish_node(static_cast<int>(node));
  finish_diaphragms({});
  set_scale();
}

void FrameSystem::request_node(int node) {
  char& wanted = wanted_[static_cast<std::size_t>(node)];
  if (wanted == 0) wanted_nodes_.push_back(node);
  wanted = 1;
}

/// The vertices of these nodes; a diaphragm takes all of its nodes along.
void FrameSystem::request_vertices_of(std::span<const int> nodes) {
  wanted_.resize(static_cast<std::size_t>(dofs().vertices()), 0);
  wanted_nodes_.clear();
  for (int node : nodes) {
    request_node(node);
    const int d = dofs().diaphragm_of_node[static_cast<std::size_t>(node)];
    if (d < 0) continue;
    wanted_[model.nodes.size() + static_cast<std::size_t>(d)] = 1;
    for (int other : model.diaphragms[static_cast<std::size_t>(d)].nodes) request_node(other);
  }
  std::sort(wanted_nodes_.begin(), wanted_nodes_.end());
}

// Entries are built again from zero, in the same order as in assemble(), and never subtracted from: what is released
// leaves exact zeros, not rounding that would pass for stiffness.
void FrameSystem::reassemble(std::span<const int> nodes) {
  request_vertices_of(nodes);
  wanted_elements_.clear();
  for (const int n : wanted_nodes_) {
    const auto node = static_cast<std::size_t>(n);
    wanted_elements_.insert(wanted_elements_.end(), elements_of_node(node).begin(), elements_of_node(node).end());
    for (int e = dofs().first_equation[node]; e < dofs().first_equation[node + 1]; ++e) {
      for (int f = dofs().first_equation[node]; f <= e; ++f) entry(e, f) = 0;
    }
  }
  std::sort(wanted_elements_.begin(), wanted_elements_.end());
  wanted_elements_.erase(std::unique(wanted_elements_.begin(), wanted_elements_.end()), wanted_elements_.end());
  for (int element : wanted_elements_) assembly_map_.clear(static_cast<std::size_t>(element), wanted_, matrix_);
  if (inertia != nullptr) clear_mass(wanted_nodes_, wanted_elements_);
  for (int element : wanted_elements_) add_element(static_cast<std::size_t>(element), wanted_);
  for (const int node : wanted_nodes_) finish_node(node);
  finish_diaphragms(wanted_);
  for (const int node : wanted_nodes_) wanted_[static_cast<std::size_t>(node)] = 0;
  std::fill(wanted_.begin() + static_cast<std::ptrdiff_t>(model.nodes.size()), wanted_.end(), char{0});
}

Vec6 FrameSystem::node_displacement_of_scaled(int node, const Eigen::VectorXd& solution) const {
  const auto n = static_cast<std::size_t>(node);
  Vec6 u = Vec6::Zero();
  if (node_stands[n] == 0) return u;
  for (std::size_t c = 0; c < 6; ++c) {
    const int e = dofs().number[n][c];
    if (e < dofs().equations) u(static_cast<Eigen::Index>(c)) = solution(e) * scale_[static_cast<std::size_t>(e)];
  }
  u(0) -= dofs().arm[n][1] * u(5);
  u(1) += dofs().arm[n][0] * u(5);
  return u;
}

void FrameSystem::node_displacements_of_scaled(const Eigen::VectorXd& solution, std::vector<Vec6>& result) const {
  for (std::size_t n = 0; n < result.size(); ++n)
    result[n] = node_displacement_of_scaled(static_cast<int>(n), solution);
}

}  // namespace topple::solver
