#include "topple/solver/superelement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "elements/condensation.h"
#include "elements/shell.h"
#include "factor/ordering.h"

namespace topple::solver {

namespace {

/// A freedom of a node as seen by the equations: up to two numbers with weights. Inner ones count from 0, kept ones
/// from `inner`; held ones have none.
struct Seen {
  std::array<int, 2> number{-1, -1};
  std::array<double, 2> weight{0, 0};
};

/// One shell in the numbers of the equations: ties are worked in.
struct Element {
  std::vector<int> number;          ///< ascending
  Eigen::MatrixXd stiffness;        ///< whole
  std::vector<std::int64_t> place;  ///< of its lower triangle by columns, in the matrix
};

/// Stiffnesses in the freedoms of the nodes; congruent shells, of which a patch is made, share one.
class OwnStiffnesses {
 public:
  const Mat24* of(const Shell& shell, const std::array<Vec3, 4>& places) {
    for (const Known& known : known_)
      if (known.places == places && known.shell.youngs_modulus == shell.youngs_modulus &&
          known.shell.poisson_ratio == shell.poisson_ratio && known.shell.thickness == shell.thickness &&
          known.shell.bending == shell.bending)
        return known.stiffness.get();
    known_.push_back({shell, places, std::make_unique<Mat24>(ShellElement(shell, places).stiffness())});
    return known_.back().stiffness.get();
  }

 private:
  struct Known {
    Shell shell;
    std::array<Vec3, 4> places;
    std::unique_ptr<Mat24> stiffness;
  };
  std::vector<Known> known_;
};

/// Lower triangle with all that these lists couple, the kept rows among themselves included; values 0.
SparseSymmetric pattern_of(const std::vector<Element>& elements, int inner, int size) {
  std::vector<std::vector<std::int32_t>> below(static_cast<std::size_t>(size));
  for (const Element& element : elements)
    for (std::size_t j = 0; j < element.number.size(); ++j) {
      auto& column = below[static_cast<std::size_t>(element.number[j])];
      column.insert(column.end(), element.number.begin() + static_cast<std::ptrdiff_t>(j), element.number.end());
    }
  SparseSymmetric pattern;
  pattern.size = size;
  pattern.start = {0};
  for (std::int32_t c = 0; c < size; ++c) {
    auto& column = below[static_cast<std::size_t>(c)];
    if (c >= inner) {
      column.resize(static_cast<std::size_t>(size - c));
      std::iota(column.begin(), column.end(), c);
    }
    column.push_back(c);
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    pattern.row.insert(pattern.row.end(), column.begin(), column.end());
    pattern.start.push_back(static_cast<std::int64_t>(pattern.row.size()));
  }
  pattern.value.assign(pattern.row.size(), 0);
  return pattern;
}

void find_places(const SparseSymmetric& pattern, Element& element) {
  const auto& number = element.number;
  for (std::size_t j = 0; j < number.size(); ++j) {
    auto at = pattern.start[static_cast<std::size_t>(number[j])];
    for (std::size_t i = j; i < number.size(); ++i) {
      while (pattern.row[static_cast<std::size_t>(at)] != number[i]) ++at;
      element.place.push_back(at);
    }
  }
}

}  // namespace

/// What stays as it is while shells go: a copy shares it.
struct Superelement::Plan {
  explicit Plan(Patch given) : patch(std::move(given)) {
    OwnStiffnesses known;
    for (std::size_t i = 0; i < patch.shells.size(); ++i) {
      check_shell(patch.shells[i], static_cast<int>(i), patch.nodes);
      own.push_back(*known.of(patch.shells[i], corner_places(patch.shells[i], patch.nodes)));
    }
    for (const int node : patch.kept)
      if (node < 0 || static_cast<std::size_t>(node) >= patch.nodes.size())
        throw std::invalid_argument("node " + std::to_string(node) + " does not exist");
    number_freedoms();
    for (std::size_t e = 0; e < patch.shells.size(); ++e) elements.push_back(element_of(e));
    pattern = pattern_of(elements, inner, size());
    for (Element& element : elements) find_places(pattern, element);
  }

  void number_freedoms();
  [[nodiscard]] Element element_of(std::size_t shell) const;
  [[nodiscard]] std::vector<int> order_of_elimination() const;
  [[nodiscard]] Seen& seen(int node, int component) { return freedoms[static_cast<std::size_t>(6 * node + component)]; }
  [[nodiscard]] const Seen& seen(int node, int component) const {
    return freedoms[static_cast<std::size_t>(6 * node + component)];
  }
  [[nodiscard]] int size() const { return inner + 6 * static_cast<int>(patch.kept.size()); }

  Patch patch;
  std::vector<Mat24> own;      ///< of each shell, whole, in the freedoms of its nodes
  std::vector<Seen> freedoms;  ///< per node and component, as long as the patch is this one
  int inner = 0;
  std::vector<Element> elements;
  SparseSymmetric pattern;
};

struct Superelement::State {
  State(Patch given, std::span<const int> gone)
      : plan(std::make_shared<const Plan>(std::move(given))),
        share(plan->patch.shells.size(), 1),
        shell_stands(plan->patch.shells.size(), 1),
        condensation(plan->pattern, plan->inner, plan->order_of_elimination()) {
    for (const int shell : gone) shell_stands[static_cast<std::size_t>(shell)] = 0;
    condense();
  }

  void condense();
  void drop_loose_shells();
  [[nodiscard]] SparseSymmetric assembled();
  [[nodiscard]] Eigen::VectorXd gathered(const std::vector<Vec6>& loads) const;

  std::shared_ptr<const Plan> plan;
  std::vector<double> share;  ///< of each that is left
  std::vector<char> shell_stands;
  std::vector<int> shells_at;  ///< per node: how many stand
  std::vector<char> alive;     ///< per inner equation: something that stands has stiffness there
  Condensation condensation;
};

/// Shells that no path over shared nodes joins to anything that holds or is seen.
void Superelement::State::drop_loose_shells() {
  const Patch& patch = plan->patch;
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

/// As if all shells stood: what goes later leaves equations without stiffness behind, so that pattern, order and
/// fronts stay.
void Superelement::Plan::number_freedoms() {
  freedoms.assign(6 * patch.nodes.size(), {});
  std::vector<char> held(freedoms.size(), 0), stiff(freedoms.size(), 0), placed(freedoms.size(), 0);
  for (const Support& support : patch.supports)
    for (int c = 0; c < 6; ++c)
      if (std::isinf(support.stiffness(c))) held[static_cast<std::size_t>(6 * support.node + c)] = 1;
  for (std::size_t i = 0; i < patch.shells.size(); ++i) {
    for (int k = 0; k < 24; ++k)
      if (own[i](k, k) > 0)
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

Element Superelement::Plan::element_of(std::size_t shell) const {
  Element element;
  const auto& nodes = patch.shells[shell].node;
  const auto seen_by = [&](int k) -> const Seen& { return seen(nodes[static_cast<std::size_t>(k / 6)], k % 6); };
  for (int k = 0; k < 24; ++k)
    for (const int number : seen_by(k).number)
      if (number >= 0) element.number.push_back(number);
  std::sort(element.number.begin(), element.number.end());
  element.number.erase(std::unique(element.number.begin(), element.number.end()), element.number.end());
  const auto count = static_cast<Eigen::Index>(element.number.size());
  const auto place_of = [&](int number) {
    return std::lower_bound(element.number.begin(), element.number.end(), number) - element.number.begin();
  };
  element.stiffness = Eigen::MatrixXd::Zero(count, count);
  for (int l = 0; l < 24; ++l)
    for (std::size_t j = 0; j < 2 && seen_by(l).number[j] >= 0; ++j) {
      const Eigen::Index column = place_of(seen_by(l).number[j]);
      for (int k = 0; k < 24; ++k)
        for (std::size_t i = 0; i < 2 && seen_by(k).number[i] >= 0; ++i)
          element.stiffness(place_of(seen_by(k).number[i]), column) +=
              seen_by(k).weight[i] * seen_by(l).weight[j] * own[shell](k, l);
    }
  return element;
}

/// Inner nodes by nested dissection. Then the kept ones, the last first: as blocks of their own, so that a front near
/// one of them does not take all of them along.
std::vector<int> Superelement::Plan::order_of_elimination() const {
  std::vector<std::vector<int>> rows(patch.nodes.size());
  for (std::size_t n = 0; n < patch.nodes.size(); ++n)
    for (std::size_t c = 0; c < 6; ++c)
      if (const int number = freedoms[6 * n + c].number[0]; number >= 0 && number < inner) rows[n].push_back(number);
  std::vector<int> nodes, place(patch.nodes.size(), -1), weight;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (rows[n].empty()) continue;
    place[n] = static_cast<int>(nodes.size());
    nodes.push_back(static_cast<int>(n));
    weight.push_back(static_cast<int>(rows[n].size()));
  }
  std::vector<std::pair<int, int>> edges;
  for (const Shell& shell : patch.shells)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const int a = place[static_cast<std::size_t>(shell.node[i])],
                  b = place[static_cast<std::size_t>(shell.node[j])];
        if (a >= 0 && b >= 0) edges.emplace_back(a, b);
      }
  std::vector<int> order;
  for (const int k : order_nodes(static_cast<int>(nodes.size()), edges, weight))
    for (const int row : rows[static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)])]) order.push_back(row);
  for (std::size_t k = patch.kept.size(); k-- > 0;)
    for (int c = 0; c < 6; ++c) order.push_back(inner + 6 * static_cast<int>(k) + c);
  return order;
}

SparseSymmetric Superelement::State::assembled() {
  const int inner = plan->inner;
  SparseSymmetric matrix = plan->pattern;
  alive.assign(static_cast<std::size_t>(inner), 0);
  for (std::size_t e = 0; e < plan->elements.size(); ++e) {
    if (shell_stands[e] == 0) continue;
    const Element& element = plan->elements[e];
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
  for (const Support& support : plan->patch.supports)
    for (int c = 0; c < 6; ++c) {
      if (!std::isfinite(support.stiffness(c)) || !(support.stiffness(c) > 0)) continue;
      const Seen& at = plan->seen(support.node, c);
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
  const int inner = plan->inner;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(plan->size());
  for (std::size_t n = 0; n < loads.size(); ++n)
    for (int c = 0; c < 6; ++c) {
      const Seen& to = plan->seen(static_cast<int>(n), c);
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
const Superelement::Patch& Superelement::patch() const { return state_->plan->patch; }

Eigen::VectorXd Superelement::condense(const std::vector<Vec6>& loads) const {
  return state_->condensation.condense(state_->gathered(loads));
}

std::vector<Vec6> Superelement::recover(const Eigen::VectorXd& kept, const std::vector<Vec6>& loads) const {
  const State& s = *state_;
  const Eigen::VectorXd all = s.condensation.recover(s.gathered(loads), kept);
  std::vector<Vec6> displacements(s.plan->patch.nodes.size(), Vec6::Zero());
  for (std::size_t n = 0; n < displacements.size(); ++n)
    for (int c = 0; c < 6; ++c) {
      const Seen& from = s.plan->seen(static_cast<int>(n), c);
      for (std::size_t i = 0; i < 2; ++i)
        if (from.number[i] >= 0) displacements[n](c) += from.weight[i] * all(from.number[i]);
    }
  return displacements;
}

Eigen::MatrixXd Superelement::shapes() const {
  const State& s = *state_;
  const Eigen::MatrixXd all = s.condensation.shapes();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(6 * s.plan->patch.nodes.size()), all.cols());
  for (Eigen::Index row = 0; row < result.rows(); ++row) {
    const Seen& from = s.plan->seen(static_cast<int>(row / 6), static_cast<int>(row % 6));
    for (std::size_t i = 0; i < 2; ++i)
      if (from.number[i] >= 0) result.row(row) += from.weight[i] * all.row(from.number[i]);
  }
  return result;
}

std::vector<Vec6> Superelement::reactions(const std::vector<Vec6>& displacements,
                                          const std::vector<Vec6>& loads) const {
  const State& s = *state_;
  std::vector<Vec6> result(s.plan->patch.nodes.size(), Vec6::Zero());
  for (std::size_t e = 0; e < s.plan->patch.shells.size(); ++e) {
    if (s.shell_stands[e] == 0) continue;
    Vec24 u;
    for (int n = 0; n < 4; ++n)
      u.segment<6>(6 * n) =
          displacements[static_cast<std::size_t>(s.plan->patch.shells[e].node[static_cast<std::size_t>(n)])];
    const Vec24 force = s.share[e] * (s.plan->own[e] * u);
    for (int n = 0; n < 4; ++n)
      result[static_cast<std::size_t>(s.plan->patch.shells[e].node[static_cast<std::size_t>(n)])] +=
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
