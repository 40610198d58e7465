#include "topple/solver/superelement.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shell.h"

namespace topple::solver {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// A freedom of a node as seen by the equations: up to two numbers with weights. Inner ones count from 0, kept ones
/// from `inner`; held ones have none.
struct Seen {
  std::array<int, 2> number{-1, -1};
  std::array<double, 2> weight{0, 0};
};

}  // namespace

struct Superelement::State {
  State(Patch given, std::span<const int> gone)
      : patch(std::move(given)), share(patch.shells.size(), 1), shell_stands(patch.shells.size(), 1) {
    for (std::size_t i = 0; i < patch.shells.size(); ++i) {
      check_shell(patch.shells[i], static_cast<int>(i), patch.nodes);
      const std::array<Vec3, 4> places = corner_places(patch.shells[i], patch.nodes);
      elements.push_back(ShellElement(patch.shells[i], places).stiffness());
    }
    for (const int node : patch.kept)
      if (node < 0 || static_cast<std::size_t>(node) >= patch.nodes.size())
        throw std::invalid_argument("node " + std::to_string(node) + " does not exist");
    for (const int shell : gone) shell_stands[static_cast<std::size_t>(shell)] = 0;
    condense();
  }

  void condense();
  void drop_loose_shells();
  void number_freedoms();
  void assemble();
  [[nodiscard]] Eigen::VectorXd gathered(const std::vector<Vec6>& loads) const;
  [[nodiscard]] Seen& seen(int node, int component) { return freedoms[static_cast<std::size_t>(6 * node + component)]; }
  [[nodiscard]] const Seen& seen(int node, int component) const {
    return freedoms[static_cast<std::size_t>(6 * node + component)];
  }

  Patch patch;
  std::vector<Mat24> elements;  ///< whole
  std::vector<double> share;    ///< of each that is left
  std::vector<char> shell_stands;
  std::vector<int> shells_at;  ///< per node: how many stand
  std::vector<Seen> freedoms;  ///< per node and component
  int inner = 0;
  Sparse inner_stiffness;
  Eigen::MatrixXd coupling;  ///< inner rows, kept columns
  Eigen::MatrixXd kept_stiffness, stiffness;
  Eigen::SimplicialLDLT<Sparse> factor;
};

/// Shells that no path over shared nodes joins to anything that holds or is seen.
void Superelement::State::drop_loose_shells() {
  std::vector<char> reached(patch.nodes.size(), 0);
  const auto reach = [&](int node) { reached[static_cast<std::size_t>(node)] = 1; };
  for (const int node : patch.kept) reach(node);
  for (const Tie& tie : patch.ties) reach(tie.node);
  for (const Support& support : patch.supports)
    if ((support.stiffness.array() > 0).any()) reach(support.node);
  std::vector<char> shell_reached(patch.shells.size(), 0);
  for (bool more = true; more;) {
    more = false;
    for (std::size_t i = 0; i < patch.shells.size(); ++i) {
      if (shell_stands[i] == 0 || shell_reached[i] != 0) continue;
      const auto& nodes = patch.shells[i].node;
      if (std::none_of(nodes.begin(), nodes.end(), [&](int n) { return reached[static_cast<std::size_t>(n)] != 0; }))
        continue;
      std::for_each(nodes.begin(), nodes.end(), reach);
      shell_reached[i] = 1;
      more = true;
    }
  }
  shell_stands = shell_reached;
  shells_at.assign(patch.nodes.size(), 0);
  for (std::size_t i = 0; i < patch.shells.size(); ++i)
    if (shell_stands[i] != 0)
      for (const int node : patch.shells[i].node) ++shells_at[static_cast<std::size_t>(node)];
}

void Superelement::State::number_freedoms() {
  freedoms.assign(6 * patch.nodes.size(), {});
  std::vector<char> held(freedoms.size(), 0), stiff(freedoms.size(), 0), placed(freedoms.size(), 0);
  for (const Support& support : patch.supports)
    for (int c = 0; c < 6; ++c)
      if (std::isinf(support.stiffness(c))) held[static_cast<std::size_t>(6 * support.node + c)] = 1;
  for (std::size_t i = 0; i < patch.shells.size(); ++i) {
    if (shell_stands[i] == 0) continue;
    for (int k = 0; k < 24; ++k)
      if (elements[i](k, k) > 0)
        stiff[static_cast<std::size_t>(6 * patch.shells[i].node[static_cast<std::size_t>(k / 6)] + k % 6)] = 1;
  }
  const auto place = [&](int node, int components) {
    for (int c = 0; c < components; ++c) placed[static_cast<std::size_t>(6 * node + c)] = 1;
  };
  for (const int node : patch.kept) place(node, 6);
  for (const Tie& tie : patch.ties) place(tie.node, tie.turns ? 6 : 3);
  inner = 0;
  for (std::size_t n = 0; n < patch.nodes.size(); ++n)
    for (std::size_t c = 0; c < 6; ++c)
      if (placed[6 * n + c] == 0 && held[6 * n + c] == 0 && stiff[6 * n + c] != 0)
        freedoms[6 * n + c] = {{inner++, -1}, {1, 0}};
  for (std::size_t k = 0; k < patch.kept.size(); ++k)
    for (int c = 0; c < 6; ++c) seen(patch.kept[k], c) = {{inner + 6 * static_cast<int>(k) + c, -1}, {1, 0}};
  for (const Tie& tie : patch.ties)
    for (int c = 0; c < (tie.turns ? 6 : 3); ++c)
      if (held[static_cast<std::size_t>(6 * tie.node + c)] == 0)
        seen(tie.node, c) = {{inner + 6 * tie.kept[0] + c, inner + 6 * tie.kept[1] + c}, {1 - tie.share, tie.share}};
}

void Superelement::State::assemble() {
  const auto kept = static_cast<Eigen::Index>(6 * patch.kept.size());
  std::vector<Eigen::Triplet<double>> entries;
  coupling = Eigen::MatrixXd::Zero(inner, kept);
  kept_stiffness = Eigen::MatrixXd::Zero(kept, kept);
  const auto add = [&](const Seen& row, const Seen& column, double value) {
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        const int r = row.number[i], c = column.number[j];
        if (r < 0 || c < 0) continue;
        const double part = row.weight[i] * column.weight[j] * value;
        if (r < inner && c < inner)
          entries.emplace_back(r, c, part);
        else if (r < inner)
          coupling(r, c - inner) += part;
        else if (c >= inner)
          kept_stiffness(r - inner, c - inner) += part;
      }
  };
  for (std::size_t e = 0; e < patch.shells.size(); ++e) {
    if (shell_stands[e] == 0) continue;
    for (int i = 0; i < 24; ++i)
      for (int j = 0; j < 24; ++j)
        if (elements[e](i, j) != 0)
          add(seen(patch.shells[e].node[static_cast<std::size_t>(i / 6)], i % 6),
              seen(patch.shells[e].node[static_cast<std::size_t>(j / 6)], j % 6), share[e] * elements[e](i, j));
  }
  for (const Support& support : patch.supports)
    for (int c = 0; c < 6; ++c)
      if (std::isfinite(support.stiffness(c)) && support.stiffness(c) > 0)
        add(seen(support.node, c), seen(support.node, c), support.stiffness(c));
  inner_stiffness.resize(inner, inner);
  inner_stiffness.setFromTriplets(entries.begin(), entries.end());
}

void Superelement::State::condense() {
  drop_loose_shells();
  number_freedoms();
  assemble();
  stiffness = kept_stiffness;
  if (inner == 0) return;
  factor.compute(inner_stiffness);
  if (factor.info() != Eigen::Success) throw std::invalid_argument("a patch of shells can move by itself");
  stiffness -= coupling.transpose() * factor.solve(coupling);
  stiffness = (0.5 * (stiffness + stiffness.transpose())).eval();
}

/// Loads by equation: inner ones, then kept ones.
Eigen::VectorXd Superelement::State::gathered(const std::vector<Vec6>& loads) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(inner + static_cast<Eigen::Index>(6 * patch.kept.size()));
  for (std::size_t n = 0; n < loads.size(); ++n)
    for (int c = 0; c < 6; ++c) {
      const Seen& to = seen(static_cast<int>(n), c);
      for (std::size_t i = 0; i < 2; ++i)
        if (to.number[i] >= 0) force(to.number[i]) += to.weight[i] * loads[n](c);
    }
  return force;
}

Superelement::Superelement(Patch patch, std::span<const int> gone)
    : state_(std::make_unique<State>(std::move(patch), gone)) {}
Superelement::~Superelement() = default;
Superelement::Superelement(Superelement&&) noexcept = default;
Superelement& Superelement::operator=(Superelement&&) noexcept = default;

void Superelement::remove(std::span<const int> shells) {
  for (const int shell : shells) state_->shell_stands[static_cast<std::size_t>(shell)] = 0;
  state_->condense();
}

void Superelement::keep(const std::vector<double>& share) {
  State& s = *state_;
  if (share.size() != s.share.size()) throw std::invalid_argument("a share is needed for each shell");
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (!(share[i] >= 0 && share[i] <= 1))
      throw std::invalid_argument("share of shell " + std::to_string(i) + "; accepted: 0 to 1");
    if (share[i] == 0) s.shell_stands[i] = 0;
  }
  s.share = share;
  s.condense();
}

bool Superelement::stands(int shell) const { return state_->shell_stands[static_cast<std::size_t>(shell)] != 0; }
bool Superelement::has_shells(int node) const { return state_->shells_at[static_cast<std::size_t>(node)] > 0; }
const Eigen::MatrixXd& Superelement::stiffness() const { return state_->stiffness; }
const Superelement::Patch& Superelement::patch() const { return state_->patch; }

Eigen::VectorXd Superelement::condense(const std::vector<Vec6>& loads) const {
  const State& s = *state_;
  const Eigen::VectorXd force = s.gathered(loads);
  Eigen::VectorXd kept = force.tail(force.size() - s.inner);
  if (s.inner > 0) kept -= s.coupling.transpose() * s.factor.solve(force.head(s.inner));
  return kept;
}

std::vector<Vec6> Superelement::recover(const Eigen::VectorXd& kept, const std::vector<Vec6>& loads) const {
  const State& s = *state_;
  Eigen::VectorXd all(s.inner + kept.size());
  all.tail(kept.size()) = kept;
  if (s.inner > 0) all.head(s.inner) = s.factor.solve(s.gathered(loads).head(s.inner) - s.coupling * kept);
  std::vector<Vec6> displacements(s.patch.nodes.size(), Vec6::Zero());
  for (std::size_t n = 0; n < displacements.size(); ++n)
    for (int c = 0; c < 6; ++c) {
      const Seen& from = s.seen(static_cast<int>(n), c);
      for (std::size_t i = 0; i < 2; ++i)
        if (from.number[i] >= 0) displacements[n](c) += from.weight[i] * all(from.number[i]);
    }
  return displacements;
}

std::vector<Vec6> Superelement::reactions(const std::vector<Vec6>& displacements,
                                          const std::vector<Vec6>& loads) const {
  const State& s = *state_;
  std::vector<Vec6> result(s.patch.nodes.size(), Vec6::Zero());
  for (std::size_t e = 0; e < s.patch.shells.size(); ++e) {
    if (s.shell_stands[e] == 0) continue;
    Vec24 u;
    for (int n = 0; n < 4; ++n)
      u.segment<6>(6 * n) =
          displacements[static_cast<std::size_t>(s.patch.shells[e].node[static_cast<std::size_t>(n)])];
    const Vec24 force = s.share[e] * (s.elements[e] * u);
    for (int n = 0; n < 4; ++n)
      result[static_cast<std::size_t>(s.patch.shells[e].node[static_cast<std::size_t>(n)])] += force.segment<6>(6 * n);
  }
  for (std::size_t n = 0; n < loads.size(); ++n) result[n] -= loads[n];
  return result;
}

std::array<Vec6, 4> traction_loads(const FrameModel& model, int index, const Vec3& traction) {
  const Shell& shell = model.shells[static_cast<std::size_t>(index)];
  const Vec24 fixed = ShellElement(shell, corner_places(shell, model.nodes)).fixed_forces(traction, 0);
  std::array<Vec6, 4> loads;
  for (int n = 0; n < 4; ++n) loads[static_cast<std::size_t>(n)] = -fixed.segment<6>(6 * n);
  return loads;
}

}  // namespace topple::solver
