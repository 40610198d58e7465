#pragma once
// A random frame that changes at random: the same changes made to a solver::Reanalysis and to a plain model, whose
// fresh analysis is what the answer is held against. For tests of this folder and for long runs.
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "frames.h"
#include "topple/solver/reanalysis.h"

namespace topple::test {

/// The bound of an answer's relative difference: rounding of what a fresh factorisation itself would lose.
inline double difference_allowed(double condition) { return std::max(1e-10, 10 * condition * 1e-16); }

/// What a fresh analysis says.
struct FreshAnswer {
  bool stable = true, nearly_unstable = false;
  StaticSolution solution;
};

class ChangingFrame {
 public:
  /// With `walls`, some bays of the first line of posts are filled by membranes that may go and come back.
  ChangingFrame(int posts, int storeys, unsigned seed, bool walls = false)
      : random_(seed), model_(tower(posts, storeys)) {
    for (int k = 0; walls && k < storeys; ++k) {
      const int foot = k * posts * posts;
      model_.shells.push_back(
          {{foot, foot + 1, foot + posts * posts + 1, foot + posts * posts}, 30e9, 0.2, 0.2, 2400, false});
    }
    for (Beam& beam : model_.beams) {
      const double size = 0.5 + share_(random_);
      beam.area *= size;
      beam.Iy *= size * size;
      beam.Iz *= size * size;
      beam.J *= size * size;
    }
    standing = std::make_unique<Reanalysis>(model_);
    weight_.resize(model_.beams.size());
    for (int i = 0; i < static_cast<int>(model_.beams.size()); ++i) {
      const Beam& b = model_.beams[static_cast<std::size_t>(i)];
      const Vec3 down = b.axes * Vec3(0, 0, -4000);
      weight_[static_cast<std::size_t>(i)] =
          uniform_load(i, b.length, components(down.x(), down.y(), down.z(), 0, 0, 0));
      standing->set_beam_loads(i, {weight_[static_cast<std::size_t>(i)]});
    }
    left_.assign(model_.nodes.size(), 0);
    node_load_.assign(model_.nodes.size(), Vec6::Zero());
  }

  /// One change: half of them breaks, the others springs and hinges, restoring, softening, supports, walls,
  /// loads, a node cut off.
  void change() {
    const int kind = pick(11);
    const int beam = pick(static_cast<int>(model_.beams.size())), end = pick(2);
    if (kind < 5) {
      set_end(beam, end, Vec6::Zero());
    } else if (kind == 5) {
      set_end(beam, end, components(rigid, rigid, rigid, rigid, 0, 1e6));
    } else if (kind == 6) {
      set_end(beam, 0, fixed());
      set_end(beam, 1, fixed());
    } else if (kind == 7) {
      soften(beam, 0.1 + share_(random_));
    } else if (kind == 8 && pick(2) == 0) {
      const int support = pick(static_cast<int>(model_.supports.size()));
      const Vec6 springs = Vec6::Constant(1e5 + 1e8 * share_(random_));
      model_.supports[static_cast<std::size_t>(support)].stiffness = springs;
      standing->set_support_stiffness(support, springs);
    } else if (kind == 8 && !model_.shells.empty()) {
      change_wall();
    } else if (kind == 10) {
      cut_off(pick(static_cast<int>(model_.nodes.size())));
    } else {
      change_load();
    }
  }

  /// Every member that reaches the node breaks there.
  void cut_off(int node) {
    for (int beam = 0; beam < static_cast<int>(model_.beams.size()); ++beam)
      for (int end = 0; end < 2; ++end)
        if (model_.beams[static_cast<std::size_t>(beam)].node[static_cast<std::size_t>(end)] == node)
          set_end(beam, end, Vec6::Zero());
  }

  /// Half of all members another stiffness: too many columns for a correction.
  void change_much() {
    for (int beam = 0; beam < static_cast<int>(model_.beams.size()); ++beam)
      if (pick(2) == 0) soften(beam, 0.5 + share_(random_));
  }

  void change_load() {
    const int node = pick(static_cast<int>(model_.nodes.size()));
    const Vec6 load = unit(pick(3), 1e4 * share_(random_));
    node_load_[static_cast<std::size_t>(node)] = load;
    standing->set_node_load(node, load);
  }

  void set_end(int beam, int end, const Vec6& stiffness) {
    model_.beams[static_cast<std::size_t>(beam)].end_stiffness[static_cast<std::size_t>(end)] = stiffness;
    standing->set_end_stiffness(beam, end, stiffness);
  }

  void soften(int beam, double factor) {
    Beam& b = model_.beams[static_cast<std::size_t>(beam)];
    const double before = factors_.contains(beam) ? factors_[beam] : 1.0;
    b.youngs_modulus *= factor / before;
    b.shear_modulus *= factor / before;
    factors_[beam] = factor;
    standing->set_beam_stiffness_factor(beam, factor);
  }

  /// Dropped nodes held, without load.
  [[nodiscard]] FreshAnswer fresh() const {
    FrameModel model = model_;
    LoadSet loads;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      if (left_[n] != 0) model.supports.push_back({static_cast<int>(n), fixed()});
      if (left_[n] == 0) loads.nodes.push_back({static_cast<int>(n), node_load_[n]});
    }
    for (std::size_t i = 0; i < model.beams.size(); ++i) {
      Beam& b = model.beams[i];
      if (stands(b)) {
        loads.beams.push_back(weight_[i]);
      } else {
        b.end_stiffness = {Vec6::Zero(), Vec6::Zero()};
      }
    }
    for (std::size_t i = model.shells.size(); i-- > 0;) {
      const auto& nodes = model.shells[i].node;
      const bool hangs_on_dropped =
          std::any_of(nodes.begin(), nodes.end(), [&](int n) { return left_[static_cast<std::size_t>(n)] != 0; });
      if (hangs_on_dropped || gone_shells_.contains(static_cast<int>(i)))
        model.shells.erase(model.shells.begin() + static_cast<std::ptrdiff_t>(i));
    }
    try {
      StaticAnalysis analysis(model);
      FreshAnswer answer;
      answer.solution = analysis.solve(std::span(&loads, 1)).front();
      answer.nearly_unstable = analysis.statistics().nearly_unstable;
      return answer;
    } catch (const Instability&) {
      return {false, false, {}};
    }
  }

  /// Whether what moves hangs on nothing: no member that holds at both ends joins it to the rest.
  [[nodiscard]] bool is_split(const Mechanism& mechanism) const {
    std::set<int> moving(mechanism.nodes.begin(), mechanism.nodes.end());
    for (const Support& support : model_.supports)
      if (moving.contains(support.node)) return false;
    for (const Beam& b : model_.beams) {
      const bool holds = !b.end_stiffness[0].isZero(0) && !b.end_stiffness[1].isZero(0);
      if (holds && stands(b) && moving.contains(b.node[0]) != moving.contains(b.node[1])) return false;
    }
    return !moving.empty();
  }

  /// Lets go of what moves.
  void drop(const Mechanism& mechanism) {
    for (const int node : mechanism.nodes) left_[static_cast<std::size_t>(node)] = 1;
    for (const int beam : mechanism.beams)
      for (int end = 0; end < 2; ++end) set_end(beam, end, Vec6::Zero());
    standing->drop_nodes(mechanism.nodes);
  }

  /// Largest difference of displacements over the largest displacement.
  [[nodiscard]] double difference(const StaticSolution& fresh) const {
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
      largest = std::max(largest, fresh.displacements[n].norm());
      difference = std::max(difference, (fresh.displacements[n] - standing->displacements()[n]).norm());
    }
    return largest > 0 ? difference / largest : difference;
  }

  std::unique_ptr<Reanalysis> standing;

 private:
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

  void change_wall() {
    const int shell = pick(static_cast<int>(model_.shells.size()));
    if (gone_shells_.erase(shell) > 0) {
      standing->restore_shell(shell);
    } else {
      gone_shells_.insert(shell);
      standing->remove_shell(shell);
    }
  }

  /// A member whose end is broken does not hang on the node there.
  [[nodiscard]] bool stands(const Beam& b) const {
    for (std::size_t e = 0; e < 2; ++e)
      if (left_[static_cast<std::size_t>(b.node[e])] != 0 && !b.end_stiffness[e].isZero(0)) return false;
    return !(b.end_stiffness[0].isZero(0) && b.end_stiffness[1].isZero(0));
  }

  std::mt19937 random_;
  std::uniform_real_distribution<double> share_{0, 1};
  FrameModel model_;
  std::vector<BeamLoad> weight_;
  std::vector<char> left_;
  std::vector<Vec6> node_load_;
  std::map<int, double> factors_;
  std::set<int> gone_shells_;
};

/// What long runs have seen.
struct ChangeTally {
  long answers = 0, mechanisms = 0, splits = 0, in_warning_band = 0;
  double difference = 0;  ///< the largest, over what is allowed
  ReanalysisCounters work;
};

/// Solves, compares with a fresh analysis, and lets go of what moves until the rest stands. Empty, or what is wrong.
inline std::string settle_and_compare(ChangingFrame& frame, ChangeTally& tally) {
  constexpr int most_releases = 400;
  for (int release = 0; release < most_releases; ++release) {
    const ReanalysisAnswer answer = frame.standing->solve();
    const FreshAnswer fresh = frame.fresh();
    const bool in_band = fresh.nearly_unstable || answer.nearly_unstable;
    tally.in_warning_band += in_band ? 1 : 0;
    if (answer.stable != fresh.stable && !in_band)
      return answer.stable ? "a mechanism is missed" : "a mechanism is reported that is none";
    if (!answer.stable) {
      ++tally.mechanisms;
      tally.splits += frame.is_split(answer.mechanism) ? 1 : 0;
      if (answer.mechanism.nodes.empty() && answer.mechanism.beams.empty()) return "a mechanism names nothing";
      frame.drop(answer.mechanism);
      continue;
    }
    ++tally.answers;
    if (!fresh.stable) return "";  // inside the warning band there is nothing to compare with
    const double share = frame.difference(fresh.solution) / difference_allowed(fresh.solution.quality.condition);
    tally.difference = std::max(tally.difference, share);
    if (!(share <= 1)) return "the answer is " + std::to_string(share) + " times the allowed difference off";
    if (!(answer.quality.backward_error < 1e-13)) return "the backward error is above 1e-13";
    return "";
  }
  return "releases do not end";
}

/// `changes` random changes, each answered and compared; every 20th is one of half of all members.
inline std::string follow(ChangingFrame& frame, int changes, ChangeTally& tally) {
  for (int i = 0; i < changes; ++i) {
    i % 20 == 19 ? frame.change_much() : frame.change();
    const std::string fault = settle_and_compare(frame, tally);
    if (!fault.empty()) return "change " + std::to_string(i) + ": " + fault;
    (void)frame.standing->solve();  // nothing changed
  }
  const ReanalysisCounters& c = frame.standing->counters();
  tally.work.unchanged += c.unchanged;
  tally.work.load_solves += c.load_solves;
  tally.work.low_rank += c.low_rank;
  tally.work.refactorisations += c.refactorisations;
  return "";
}

/// Frame number n of a long run: one in ten of 5,100 freedoms, every third with walls.
inline ChangingFrame numbered_frame(unsigned n) {
  if (n % 10 == 9) return {5, 34, n, n % 3 == 0};
  return {2 + static_cast<int>(n % 4), 3 + static_cast<int>(n % 7), n, n % 3 == 0};
}

}  // namespace topple::test
