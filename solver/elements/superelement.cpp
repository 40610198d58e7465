#include "topple/solver/superelement.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "elements/condensation.h"
#include "elements/shell.h"
#include "elements/superelement_plan.h"

namespace topple::solver {

struct Superelement::State {
  State(Patch given, std::span<const int> gone)
      : plan(std::make_shared<const Superelement::Plan>(std::move(given))),
        share(plan->patch().shells.size(), 1),
        shell_stands(plan->patch().shells.size(), 1),
        condensation(plan->pattern(), plan->inner(), plan->order_of_elimination()) {
    for (const int shell : gone) shell_stands[static_cast<std::size_t>(shell)] = 0;
    condense();
  }

  void condense();
  void drop_loose_shells();
  [[nodiscard]] SparseSymmetric assembled();
  [[nodiscard]] Eigen::VectorXd gathered(const std::vector<Vec6>& loads) const;

  std::shared_ptr<const Superelement::Plan> plan;
  std::vector<double> share;  ///< of each that is left
  std::vector<char> shell_stands;
  std::vector<int> shells_at;  ///< per node: how many stand
  std::vector<char> alive;     ///< per inner equation: something that stands has stiffness there
  Condensation condensation;
};

/// Shells that no path over shared nodes joins to anything that holds or is seen.
void Superelement::State::drop_loose_shells() {
  const Patch& patch = plan->patch();
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

SparseSymmetric Superelement::State::assembled() {
  const int inner = plan->inner();
  SparseSymmetric matrix = plan->pattern();
  alive.assign(static_cast<std::size_t>(inner), 0);
  for (std::size_t e = 0; e < plan->elements().size(); ++e) {
    if (shell_stands[e] == 0) continue;
    const Superelement::Plan::Element& element = plan->elements()[e];
    const std::int64_t* place = element.place.data();
    const auto count = static_cast<Eigen::Index>(element.number.size());
    for (Eigen::Index j = 0; j < count; ++j) {
      const int number = element.number[static_cast<std::size_t>(j)];
      if (number < inner && element.stiffness(j, j) > 0) alive[static_cast<std::size_t>(number)] = 1;
      for (Eigen::Index i = j; i < count; ++i)
        matrix.value[static_cast<std::size_t>(*place++)] += share[e] * element.stiffness(i, j);
    }
  }
  const auto entry = [&](int row, int column) -> double& {  // of the diagonal, or between kept rows
    return matrix.value[static_cast<std::size_t>(matrix.start[static_cast<std::size_t>(column)] + row - column)];
  };
  for (const Support& support : plan->patch().supports)
    for (int c = 0; c < 6; ++c) {
      if (!std::isfinite(support.stiffness(c)) || !(support.stiffness(c) > 0)) continue;
      const Superelement::Plan::Seen& at = plan->seen(support.node, c);
      for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 2; ++j) {
          const int row = at.number[i], column = at.number[j];
          if (column < 0 || row < column) continue;
          if (row < inner && alive[static_cast<std::size_t>(row)] == 0) continue;
          entry(row, column) += at.weight[i] * at.weight[j] * support.stiffness(c);
        }
    }
  for (int number = 0; number < inner; ++number)
    if (alive[static_cast<std::size_t>(number)] == 0) entry(number, number) = 1;
  return matrix;
}

void Superelement::State::condense() {
  drop_loose_shells();
  if (!condensation.factorise(assembled())) throw std::invalid_argument("a patch of shells can move by itself");
}

/// Loads by equation: inner ones, then kept ones.
/// Where nothing stands they act on nothing.
Eigen::VectorXd Superelement::State::gathered(const std::vector<Vec6>& loads) const {
  const int inner = plan->inner();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(plan->size());
  for (std::size_t n = 0; n < loads.size(); ++n)
    for (int c = 0; c < 6; ++c) {
      const Superelement::Plan::Seen& to = plan->seen(static_cast<int>(n), c);
      for (std::size_t i = 0; i < 2; ++i)
        if (to.number[i] >= inner || (to.number[i] >= 0 && alive[static_cast<std::size_t>(to.number[i])] != 0))
          force(to.number[i]) += to.weight[i] * loads[n](c);
    }
  return force;
}

Superelement::Superelement(Patch patch, std::span<const int> gone)
    : state_(std::make_unique<State>(std::move(patch), gone)) {}
Superelement::Superelement(const Superelement& other) : state_(std::make_unique<State>(*other.state_)) {}
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
const Eigen::MatrixXd& Superelement::stiffness() const { return state_->condensation.schur(); }
const Superelement::Patch& Superelement::patch() const { return state_->plan->patch(); }

Eigen::VectorXd Superelement::condense(const std::vector<Vec6>& loads) const {
  return state_->condensation.condense(state_->gathered(loads));
}

std::vector<Vec6> Superelement::recover(const Eigen::VectorXd& kept, const std::vector<Vec6>& loads) const {
  const State& s = *state_;
  const Eigen::VectorXd all = s.condensation.recover(s.gathered(loads), kept);
  std::vector<Vec6> displacements(s.plan->patch().nodes.size(), Vec6::Zero());
  for (std::size_t n = 0; n < displacements.size(); ++n)
    for (int c = 0; c < 6; ++c) {
      const Superelement::Plan::Seen& from = s.plan->seen(static_cast<int>(n), c);
      for (std::size_t i = 0; i < 2; ++i)
        if (from.number[i] >= 0) displacements[n](c) += from.weight[i] * all(from.number[i]);
    }
  return displacements;
}

Eigen::MatrixXd Superelement::shapes() const {
  const State& s = *state_;
  const Eigen::MatrixXd all = s.condensation.shapes();
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(6 * s.plan->patch().nodes.size()), all.cols());
  for (Eigen::Index row = 0; row < result.rows(); ++row) {
    const Superelement::Plan::Seen& from = s.plan->seen(static_cast<int>(row / 6), static_cast<int>(row % 6));
    for (std::size_t i = 0; i < 2; ++i)
      if (from.number[i] >= 0) result.row(row) += from.weight[i] * all.row(from.number[i]);
  }
  return result;
}

std::vector<Vec6> Superelement::reactions(const std::vector<Vec6>& displacements,
                                          const std::vector<Vec6>& loads) const {
  const State& s = *state_;
  std::vector<Vec6> result(s.plan->patch().nodes.size(), Vec6::Zero());
  for (std::size_t e = 0; e < s.plan->patch().shells.size(); ++e) {
    if (s.shell_stands[e] == 0) continue;
    Vec24 u;
    for (int n = 0; n < 4; ++n)
      u.segment<6>(6 * n) =
          displacements[static_cast<std::size_t>(s.plan->patch().shells[e].node[static_cast<std::size_t>(n)])];
    const Vec24 force = s.share[e] * (s.plan->own(e) * u);
    for (int n = 0; n < 4; ++n)
      result[static_cast<std::size_t>(s.plan->patch().shells[e].node[static_cast<std::size_t>(n)])] +=
          force.segment<6>(6 * n);
  }
  for (std::size_t n = 0; n < loads.size(); ++n) result[n] -= loads[n];
  return result;
}

Mat24 shell_mass(const FrameModel& model, int index, double per_area) {
  const Shell& shell = model.shells[static_cast<std::size_t>(index)];
  const ShellElement element(shell, corner_places(shell, model.nodes));
  return element.mass(per_area, false) + element.rotary_mass(per_area * shell.thickness * shell.thickness / 12);
}

std::array<Vec6, 4> traction_loads(const FrameModel& model, int index, const Vec3& traction) {
  const Shell& shell = model.shells[static_cast<std::size_t>(index)];
  const Vec24 fixed = ShellElement(shell, corner_places(shell, model.nodes)).fixed_forces(traction, 0);
  std::array<Vec6, 4> loads;
  for (int n = 0; n < 4; ++n) loads[static_cast<std::size_t>(n)] = -fixed.segment<6>(6 * n);
  return loads;
}

}  // namespace topple::solver
