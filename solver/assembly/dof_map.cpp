#include "assembly/dof_map.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace topple::solver {

std::vector<Vec6> support_stiffness(const FrameModel& model) {
  std::vector<Vec6> result(model.nodes.size(), Vec6::Zero());
  for (std::size_t i = 0; i < model.supports.size(); ++i) {
    const Support& support = model.supports[i];
    if (support.node < 0 || support.node >= static_cast<int>(model.nodes.size())) {
      throw std::invalid_argument("support " + std::to_string(i) + ": node " + std::to_string(support.node) +
                                  " does not exist");
    }
    if (!(support.stiffness.array() >= 0).all()) {
      throw std::invalid_argument("support " + std::to_string(i) + ": stiffness must be 0, a positive spring or rigid");
    }
    result[static_cast<std::size_t>(support.node)] += support.stiffness;
  }
  return result;
}

namespace {

/// What the held components of a diaphragm's nodes do to its three freedoms. The reference point lies where the first
/// held x and the first held y act, so that each held component is a freedom of the reference point or follows from
/// them.
struct DiaphragmHold {
  std::array<double, 2> reference{};
  std::array<bool, 3> held{};
};

DiaphragmHold hold_of(const FrameModel& model, const Diaphragm& diaphragm, const std::vector<Vec6>& support) {
  DiaphragmHold result;
  for (int node : diaphragm.nodes) {
    const Vec3& p = model.nodes[static_cast<std::size_t>(node)];
    result.reference[0] += p.x() / static_cast<double>(diaphragm.nodes.size());
    result.reference[1] += p.y() / static_cast<double>(diaphragm.nodes.size());
  }
  for (int node : diaphragm.nodes) {
    const Vec3& p = model.nodes[static_cast<std::size_t>(node)];
    const Vec6& k = support[static_cast<std::size_t>(node)];
    if (std::isinf(k(0))) {
      if (!result.held[0]) result.reference[1] = p.y();
      if (result.held[0] && p.y() != result.reference[1]) result.held[2] = true;
      result.held[0] = true;
    }
    if (std::isinf(k(1))) {
      if (!result.held[1]) result.reference[0] = p.x();
      if (result.held[1] && p.x() != result.reference[0]) result.held[2] = true;
      result.held[1] = true;
    }
    if (std::isinf(k(5))) result.held[2] = true;
  }
  return result;
}

void check_diaphragm(const FrameModel& model, std::size_t index, std::vector<int>& diaphragm_of_node) {
  for (int node : model.diaphragms[index].nodes) {
    const std::string place = "diaphragm " + std::to_string(index) + ": node " + std::to_string(node);
    if (node < 0 || node >= static_cast<int>(model.nodes.size()))
      throw std::invalid_argument(place + " does not exist");
    int& owner = diaphragm_of_node[static_cast<std::size_t>(node)];
    if (owner >= 0) throw std::invalid_argument(place + " is in a diaphragm already");
    owner = static_cast<int>(index);
  }
}

}  // namespace

DofMap::DofMap(const FrameModel& model) {
  const std::size_t nodes = model.nodes.size();
  const std::vector<Vec6> support = support_stiffness(model);
  number.assign(nodes, {-1, -1, -1, -1, -1, -1});
  arm.assign(nodes, {0, 0});
  diaphragm_of_node.assign(nodes, -1);
  std::vector<DiaphragmHold> holds;
  for (std::size_t d = 0; d < model.diaphragms.size(); ++d) {
    check_diaphragm(model, d, diaphragm_of_node);
    holds.push_back(hold_of(model, model.diaphragms[d], support));
    diaphragm_reference.push_back(holds.back().reference);
  }
  const auto shared = [&](std::size_t node, int c) { return diaphragm_of_node[node] >= 0 && (c < 2 || c == 5); };
  first_equation.push_back(0);
  for (std::size_t node = 0; node < nodes; ++node) {
    for (int c = 0; c < 6; ++c) {
      if (!shared(node, c) && !std::isinf(support[node](c))) number[node][static_cast<std::size_t>(c)] = equations++;
    }
    first_equation.push_back(equations);
  }
  for (const DiaphragmHold& hold : holds) {
    diaphragm_number.push_back({-1, -1, -1});
    for (std::size_t c = 0; c < 3; ++c) {
      if (!hold.held[c]) diaphragm_number.back()[c] = equations++;
    }
    first_equation.push_back(equations);
  }
  for (auto& numbers : diaphragm_number) {
    for (int& n : numbers) {
      if (n < 0) n = equations + held++;
    }
  }
  for (std::size_t node = 0; node < nodes; ++node) {
    const int d = diaphragm_of_node[node];
    if (d >= 0) {
      const auto& shared_number = diaphragm_number[static_cast<std::size_t>(d)];
      number[node][0] = shared_number[0];
      number[node][1] = shared_number[1];
      number[node][5] = shared_number[2];
      const auto& reference = diaphragm_reference[static_cast<std::size_t>(d)];
      arm[node] = {model.nodes[node].x() - reference[0], model.nodes[node].y() - reference[1]};
    }
    for (int& n : number[node]) {
      if (n < 0) n = equations + held++;
    }
  }
  vertex_of_equation.resize(static_cast<std::size_t>(equations));
  for (int v = 0; v < vertices(); ++v) {
    for (int e = first_equation[static_cast<std::size_t>(v)]; e < first_equation[static_cast<std::size_t>(v) + 1];
         ++e) {
      vertex_of_equation[static_cast<std::size_t>(e)] = v;
    }
  }
}

Mat3 DofMap::diaphragm_arm(int node) const {
  Mat3 m = Mat3::Zero();
  m(0, 2) = -arm[static_cast<std::size_t>(node)][1];
  m(1, 2) = arm[static_cast<std::size_t>(node)][0];
  return m;
}

Vec6 DofMap::node_displacement(int node, const double* freedoms) const {
  Vec6 u;
  const auto n = static_cast<std::size_t>(node);
  for (int c = 0; c < 6; ++c) u(c) = freedoms[number[n][static_cast<std::size_t>(c)]];
  u(0) -= arm[n][1] * u(5);
  u(1) += arm[n][0] * u(5);
  return u;
}

void DofMap::add_node_force(int node, const Vec6& force, double* freedoms) const {
  const auto n = static_cast<std::size_t>(node);
  for (int c = 0; c < 6; ++c) freedoms[number[n][static_cast<std::size_t>(c)]] += force(c);
  freedoms[number[n][5]] += arm[n][0] * force(1) - arm[n][1] * force(0);
}

}  // namespace topple::solver
