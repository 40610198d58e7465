#include "elements/superelement_plan.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "factor/ordering.h"

namespace topple::solver {
namespace {

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

}  // namespace

SparseSymmetric Superelement::Plan::pattern_of(const std::vector<Element>& elements, int inner, int size) {
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

void Superelement::Plan::find_places(const SparseSymmetric& pattern, Element& element) {
  const auto& number = element.number;
  for (std::size_t j = 0; j < number.size(); ++j) {
    auto at = pattern.start[static_cast<std::size_t>(number[j])];
    for (std::size_t i = j; i < number.size(); ++i) {
      while (pattern.row[static_cast<std::size_t>(at)] != number[i]) ++at;
      element.place.push_back(at);
    }
  }
}

Superelement::Plan::Plan(Superelement::Patch patch) : patch_(std::move(patch)) {
  OwnStiffnesses known;
  for (std::size_t i = 0; i < patch_.shells.size(); ++i) {
    check_shell(patch_.shells[i], static_cast<int>(i), patch_.nodes);
    own_.push_back(*known.of(patch_.shells[i], corner_places(patch_.shells[i], patch_.nodes)));
  }
  for (const int node : patch_.kept)
    if (node < 0 || static_cast<std::size_t>(node) >= patch_.nodes.size())
      throw std::invalid_argument("node " + std::to_string(node) + " does not exist");
  number_freedoms();
  for (std::size_t e = 0; e < patch_.shells.size(); ++e) elements_.push_back(element_of(e));
  pattern_ = pattern_of(elements_, inner_, size());
  for (Element& element : elements_) find_places(pattern_, element);
}

void Superelement::Plan::number_freedoms() {
  freedoms_.assign(6 * patch_.nodes.size(), {});
  std::vector<char> held(freedoms_.size(), 0), stiff(freedoms_.size(), 0), placed(freedoms_.size(), 0);
  for (const Support& support : patch_.supports)
    for (int c = 0; c < 6; ++c)
      if (std::isinf(support.stiffness(c))) held[static_cast<std::size_t>(6 * support.node + c)] = 1;
  for (std::size_t i = 0; i < patch_.shells.size(); ++i) {
    for (int k = 0; k < 24; ++k)
      if (own_[i](k, k) > 0)
        stiff[static_cast<std::size_t>(6 * patch_.shells[i].node[static_cast<std::size_t>(k / 6)] + k % 6)] = 1;
  }
  const auto place = [&](int node, int components) {
    for (int c = 0; c < components; ++c) placed[static_cast<std::size_t>(6 * node + c)] = 1;
  };
  for (const int node : patch_.kept) place(node, 6);
  for (const Tie& tie : patch_.ties) place(tie.node, tie.turns ? 6 : 3);
  inner_ = 0;
  for (std::size_t n = 0; n < patch_.nodes.size(); ++n)
    for (std::size_t c = 0; c < 6; ++c)
      if (placed[6 * n + c] == 0 && held[6 * n + c] == 0 && stiff[6 * n + c] != 0)
        freedoms_[6 * n + c] = {{inner_++, -1}, {1, 0}};
  const auto seen = [&](int node, int c) -> Seen& { return freedoms_[static_cast<std::size_t>(6 * node + c)]; };
  for (std::size_t k = 0; k < patch_.kept.size(); ++k)
    for (int c = 0; c < 6; ++c) seen(patch_.kept[k], c) = {{inner_ + 6 * static_cast<int>(k) + c, -1}, {1, 0}};
  for (const Tie& tie : patch_.ties)
    for (int c = 0; c < (tie.turns ? 6 : 3); ++c)
      if (held[static_cast<std::size_t>(6 * tie.node + c)] == 0)
        seen(tie.node, c) = {{inner_ + 6 * tie.kept[0] + c, inner_ + 6 * tie.kept[1] + c}, {1 - tie.share, tie.share}};
}

Superelement::Plan::Element Superelement::Plan::element_of(std::size_t shell) const {
  Element element;
  const auto& nodes = patch_.shells[shell].node;
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
              seen_by(k).weight[i] * seen_by(l).weight[j] * own_[shell](k, l);
    }
  return element;
}

std::vector<int> Superelement::Plan::order_of_elimination() const {
  std::vector<std::vector<int>> rows(patch_.nodes.size());
  for (std::size_t n = 0; n < patch_.nodes.size(); ++n)
    for (std::size_t c = 0; c < 6; ++c)
      if (const int number = freedoms_[6 * n + c].number[0]; number >= 0 && number < inner_) rows[n].push_back(number);
  std::vector<int> nodes, place(patch_.nodes.size(), -1), weight;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (rows[n].empty()) continue;
    place[n] = static_cast<int>(nodes.size());
    nodes.push_back(static_cast<int>(n));
    weight.push_back(static_cast<int>(rows[n].size()));
  }
  std::vector<std::pair<int, int>> edges;
  for (const Shell& shell : patch_.shells)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const int a = place[static_cast<std::size_t>(shell.node[i])],
                  b = place[static_cast<std::size_t>(shell.node[j])];
        if (a >= 0 && b >= 0) edges.emplace_back(a, b);
      }
  std::vector<int> order;
  for (const int k : order_nodes(static_cast<int>(nodes.size()), edges, weight))
    for (const int row : rows[static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)])]) order.push_back(row);
  for (std::size_t k = patch_.kept.size(); k-- > 0;)
    for (int c = 0; c < 6; ++c) order.push_back(inner_ + 6 * static_cast<int>(k) + c);
  return order;
}

}  // namespace topple::solver
