#include "extended_frame.h"

#include <algorithm>
#include <numeric>

#include "extended_beam.h"
#include "profile_matrix.h"

namespace reference {

namespace {

using topple::solver::Beam;
using topple::solver::BeamLoad;
using topple::solver::FrameModel;
using topple::solver::LoadSet;

void check(const FrameModel& model, const LoadSet& loads) {
  require(model.shells.empty(), "shells");
  require(model.diaphragms.empty(), "diaphragms");
  require(loads.settlements.empty(), "settlements");
  require(loads.shells.empty(), "loads of shells");
}

/// Numbers of the free freedoms, -1 for held ones, and how they fill a profile.
struct Numbering {
  std::vector<std::array<int, 6>> number;
  std::vector<std::size_t> first;  // column of the first entry of each row
  std::size_t profile = 0;

  Numbering(const FrameModel& model, const std::vector<std::size_t>& order) {
    std::vector<std::array<bool, 6>> held(model.nodes.size());
    for (const auto& support : model.supports) {
      for (int c = 0; c < 6; ++c) held[support.node][c] = std::isinf(support.stiffness[c]);
    }
    number.resize(model.nodes.size());
    int count = 0;
    for (const std::size_t node : order) {
      for (int c = 0; c < 6; ++c) number[node][c] = held[node][c] ? -1 : count++;
    }
    first.resize(static_cast<std::size_t>(count));
    std::iota(first.begin(), first.end(), std::size_t{0});
    for (const Beam& beam : model.beams) {
      int least = count;
      for (const int node : beam.node) {
        for (const int n : number[node]) least = n >= 0 ? std::min(least, n) : least;
      }
      for (const int node : beam.node) {
        for (const int n : number[node]) {
          if (n >= 0) first[n] = std::min(first[n], static_cast<std::size_t>(least));
        }
      }
    }
    for (std::size_t i = 0; i < first.size(); ++i) profile += i - first[i];
  }
};

/// Nodes by height (a building's band is then one storey), or as they come (a chain's is one member): what fills less.
Numbering number_freedoms(const FrameModel& model) {
  std::vector<std::size_t> order(model.nodes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Numbering as_given(model, order);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return model.nodes[a].z() < model.nodes[b].z(); });
  Numbering by_height(model, order);
  return as_given.profile < by_height.profile ? std::move(as_given) : std::move(by_height);
}

template <typename Real>
Vector12<Real> product(const Matrix12<Real>& k, const Vector12<Real>& u) {
  Vector12<Real> f{};
  for (std::size_t p = 0; p < 12; ++p) {
    for (std::size_t q = 0; q < 12; ++q) f[p] += k[p][q] * u[q];
  }
  return f;
}

std::vector<std::vector<const BeamLoad*>> loads_by_beam(const FrameModel& model, const LoadSet& loads) {
  std::vector<std::vector<const BeamLoad*>> by_beam(model.beams.size());
  for (const BeamLoad& load : loads.beams) by_beam[static_cast<std::size_t>(load.beam)].push_back(&load);
  return by_beam;
}

template <typename Real>
void add_beam(const Beam& beam, const ElementEquations<Real>& e, const Numbering& numbering, ProfileMatrix<Real>& K,
              std::vector<Real>& x) {
  const auto equation = [&](std::size_t i) { return numbering.number[beam.node[i / 6]][i % 6]; };
  const Vector12<Real> load = turn(beam, e.load, false);
  for (std::size_t j = 0; j < 12; ++j) {
    const int column = equation(j);
    if (column < 0) continue;
    x[column] += load[j];
    Vector12<Real> unit{};
    unit[j] = 1;
    const Vector12<Real> force = turn(beam, product(e.stiffness, turn(beam, unit, true)), false);
    for (std::size_t i = 0; i < 12; ++i) {
      const int row = equation(i);
      if (row >= column) K.at(row, column) += force[i];
    }
  }
}

/// End forces of every beam, and from the sums at the nodes the reactions.
template <typename Real>
void recover(const FrameModel& model, const LoadSet& loads, Answer<Real>& answer) {
  const auto by_beam = loads_by_beam(model, loads);
  std::vector<std::array<Real, 6>> node_sum(model.nodes.size());
  for (std::size_t b = 0; b < model.beams.size(); ++b) {
    const Beam& beam = model.beams[b];
    const auto e = element_equations<Real>(beam, by_beam[b]);
    Vector12<Real> global{};
    for (std::size_t i = 0; i < 12; ++i) global[i] = answer.displacements[beam.node[i / 6]][i % 6];
    Vector12<Real> force = product(e.stiffness, turn(beam, global, true));
    for (std::size_t i = 0; i < 12; ++i) force[i] -= e.load[i];
    answer.beam_end_forces.push_back(force);
    const Vector12<Real> at_nodes = turn(beam, force, false);
    for (std::size_t i = 0; i < 12; ++i) node_sum[beam.node[i / 6]][i % 6] += at_nodes[i];
  }
  for (const auto& load : loads.nodes) {
    for (int c = 0; c < 6; ++c) node_sum[load.node][c] -= Real(load.load[c]);
  }
  for (const auto& support : model.supports) answer.reactions.push_back(node_sum[support.node]);
}

}  // namespace

template <typename Real>
Answer<Real> solve(const FrameModel& model, const LoadSet& loads) {
  check(model, loads);
  const Numbering numbering = number_freedoms(model);
  ProfileMatrix<Real> K(numbering.first);
  std::vector<Real> x(numbering.first.size(), Real(0));
  for (const auto& support : model.supports) {
    for (int c = 0; c < 6; ++c) {
      const int n = numbering.number[support.node][c];
      if (n >= 0) K.at(n, n) += Real(support.stiffness[c]);
    }
  }
  for (const auto& load : loads.nodes) {
    for (int c = 0; c < 6; ++c) {
      const int n = numbering.number[load.node][c];
      if (n >= 0) x[n] += Real(load.load[c]);
    }
  }
  const auto by_beam = loads_by_beam(model, loads);
  for (std::size_t b = 0; b < model.beams.size(); ++b)
    add_beam(model.beams[b], element_equations<Real>(model.beams[b], by_beam[b]), numbering, K, x);
  K.factorise();
  K.solve(x);
  Answer<Real> answer;
  answer.displacements.resize(model.nodes.size());
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    for (int c = 0; c < 6; ++c) {
      const int equation = numbering.number[n][c];
      answer.displacements[n][c] = equation < 0 ? Real(0) : x[equation];
    }
  }
  recover(model, loads, answer);
  return answer;
}

template Answer<Extended> solve<Extended>(const FrameModel&, const LoadSet&);
template Answer<Quad> solve<Quad>(const FrameModel&, const LoadSet&);

}  // namespace reference
