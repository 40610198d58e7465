// Nodes and beams that nothing holds, and loads that nothing bears.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "assembly/frame_system.h"

namespace topple::solver {

void require_none(const std::optional<Defect>& defect) {
  if (defect) throw Instability(defect->message, defect->motion);
}

Mat6 FrameSystem::supports_and_inert_motions(int node) const {
  const auto n = static_cast<std::size_t>(node);
  Mat6 K = Mat6::Zero();
  if (node_stands[n] == 0) return K;
  K.diagonal() = own_springs(node);
  inert_.add_stiffness(n, K);
  return K;
}

FrameSystem::NodeMatrix FrameSystem::own_stiffness(int node) const {
  const auto n = static_cast<std::size_t>(node);
  const int first = dofs().first_equation[n], count = dofs().first_equation[n + 1] - first;
  const Mat6 K = supports_and_inert_motions(node);
  const std::span<const double> own_scale = scale().subspan(static_cast<std::size_t>(first));
  NodeMatrix own = NodeMatrix::Zero(count, count);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const int row = dofs().number[n][static_cast<std::size_t>(i)] - first,
                column = dofs().number[n][static_cast<std::size_t>(j)] - first;
      if (row < 0 || column < 0 || row >= count || column >= count) continue;
      own(row, column) +=
          K(i, j) * own_scale[static_cast<std::size_t>(row)] * own_scale[static_cast<std::size_t>(column)];
    }
  }
  return own;
}

std::optional<Defect> FrameSystem::defect() const {
  std::vector<int> nodes(model.nodes.size()), beams(model.beams.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::iota(beams.begin(), beams.end(), 0);
  return defect(nodes, beams);
}

std::optional<Defect> FrameSystem::defect(std::span<const int> nodes) const {
  const auto sort_unique = [](std::vector<int>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  };
  judged_nodes_.assign(nodes.begin(), nodes.end());
  sort_unique(judged_nodes_);
  judged_beams_.clear();
  for (int node : judged_nodes_) {
    const std::span<const int> here = beams_of_node(node);
    judged_beams_.insert(judged_beams_.end(), here.begin(), here.end());
  }
  sort_unique(judged_beams_);
  return defect(judged_nodes_, judged_beams_);
}

std::optional<Defect> FrameSystem::defect(std::span<const int> nodes, std::span<const int> beams) const {
  std::optional<Defect> result = unheld_freedoms(nodes);
  return result ? std::move(result) : loose_beams(beams);
}

std::optional<Defect> FrameSystem::unheld_freedoms(std::span<const int> nodes) const {
  static const std::array<const char*, 6> names{"x", "y", "z", "rx", "ry", "rz"};
  std::optional<Defect> result;
  std::string components;
  for (const int index : nodes) {
    const auto node = static_cast<std::size_t>(index);
    if (node_stands[node] == 0) continue;
    for (std::size_t c = 0; c < 6; ++c) {
      const int e = dofs().number[node][c];
      if (e >= dofs().equations) continue;
      const double diagonal = matrix_.value[static_cast<std::size_t>(matrix_.start[static_cast<std::size_t>(e)])];
      if (diagonal > 0) continue;
      if (!result) {
        result.emplace();
        result->motion.motion.assign(model.nodes.size(), Vec6::Zero());
      }
      std::vector<int>& isolated = result->motion.nodes;
      if (isolated.empty() || isolated.back() != index) isolated.push_back(index);
      if (isolated.size() == 1) components += std::string(components.empty() ? "" : ", ") + names[c];
      result->motion.motion[node](static_cast<Eigen::Index>(c)) = 1;
    }
  }
  if (result) {
    const std::vector<int>& isolated = result->motion.nodes;
    result->message = "unstable: nothing holds " + list_nodes(isolated) + " (node " + std::to_string(isolated[0]) +
                      " in " + components + ")";
  }
  return result;
}

std::optional<Defect> FrameSystem::loose_beams(std::span<const int> beams) const {
  std::optional<Defect> result;
  for (const int beam : beams) {
    const auto i = static_cast<std::size_t>(beam);
    if (beam_stands[i] == 0 || !CondensedBeam(model.beams[i], beam_factor[i]).loose()) continue;
    if (!result) {
      result.emplace();
      result->motion.motion.assign(model.nodes.size(), Vec6::Zero());
    }
    result->motion.beams.push_back(beam);
  }
  if (!result) return result;
  const std::vector<int>& loose = result->motion.beams;
  result->message = "unstable: beam " + std::to_string(loose[0]) + " can move by itself: its ends are released too far";
  if (loose.size() > 1) result->message += " (and " + std::to_string(loose.size() - 1) + " more beams)";
  return result;
}

std::optional<Defect> FrameSystem::unbalanced_load(const LoadVector& load, double lever_share) const {
  constexpr InertMotions::Kind turning = InertMotions::Kind::rotation;
  if (load.unbalanced_beams.empty() && !inert_.any(turning)) return std::nullopt;
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
      const int e = dofs().number[node][c];
      if (e < dofs().equations) m(static_cast<Eigen::Index>(c) - 3) = load.force(e);
    }
    return m;
  };
  for (std::size_t node = 0; node < model.nodes.size(); ++node) largest = std::max(largest, moment_at(node).norm());
  if (lever_share > 0) {
    double longest = 0, force = 0;
    for (const Beam& beam : model.beams) longest = std::max(longest, beam.length);
    for (const auto& numbers : dofs().number)
      for (std::size_t c = 0; c < 3; ++c)
        if (numbers[c] < dofs().equations) force = std::max(force, std::abs(load.force(numbers[c])));
    lever_moment = lever_share * longest * force;
  }
  constexpr double rounding = 1e-10;  // of the largest moment on any node
  const double nothing = std::max(rounding * largest, lever_moment);
  for (std::size_t node = 0; node < model.nodes.size(); ++node) {
    const InertMotions::Node& inert = inert_.of(turning, node);
    for (int k = 0; k < inert.count; ++k) {
      const Vec3 axis = inert.directions.col(k);
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

}  // namespace topple::solver
