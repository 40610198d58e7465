// Random sequences of changes on random frames: whatever rung the ladder takes, the answer is that of a fresh analysis
// of the changed model, and what is a mechanism there is one here.
#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <random>
#include <set>

#include "frames.h"
#include "topple/solver/reanalysis.h"

using namespace topple::test;

namespace {

/// The bound of the design: rounding of what a fresh factorisation itself would lose.
double tolerance(double condition) { return std::max(1e-10, 10 * condition * 1e-16); }

struct Tally {
  int mechanisms = 0, answers = 0;
};

/// A random frame, its changes so far, and the same changes made to a plain model for a fresh analysis.
class RandomFrame {
 public:
  /// With `walls`, some bays of the first line of posts are filled by membranes that may go and come back.
  RandomFrame(int posts, int storeys, unsigned seed, bool walls = false)
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

  void change() {
    const int kind = pick(10);
    const int beam = pick(static_cast<int>(model_.beams.size())), end = pick(2);
    Beam& b = model_.beams[static_cast<std::size_t>(beam)];
    if (kind < 5) {
      set_end(beam, end, Vec6::Zero());
    } else if (kind == 5) {
      set_end(beam, end, components(rigid, rigid, rigid, rigid, 0, 1e6));
    } else if (kind == 6) {
      set_end(beam, 0, fixed());
      set_end(beam, 1, fixed());
    } else if (kind == 7) {
      const double factor = 0.1 + share_(random_);
      const double before = factors_.contains(beam) ? factors_[beam] : 1.0;
      b.youngs_modulus *= factor / before;
      b.shear_modulus *= factor / before;
      factors_[beam] = factor;
      standing->set_beam_stiffness_factor(beam, factor);
    } else if (kind == 8 && pick(2) == 0) {
      const int support = pick(static_cast<int>(model_.supports.size()));
      const Vec6 springs = Vec6::Constant(1e5 + 1e8 * share_(random_));
      model_.supports[static_cast<std::size_t>(support)].stiffness = springs;
      standing->set_support_stiffness(support, springs);
    } else if (kind == 8 && !model_.shells.empty()) {
      const int shell = pick(static_cast<int>(model_.shells.size()));
      if (gone_shells_.erase(shell) > 0) {
        standing->restore_shell(shell);
      } else {
        gone_shells_.insert(shell);
        standing->remove_shell(shell);
      }
    } else {
      const int node = pick(static_cast<int>(model_.nodes.size()));
      const Vec6 load = unit(pick(3), 1e4 * share_(random_));
      node_load_[static_cast<std::size_t>(node)] = load;
      standing->set_node_load(node, load);
    }
  }

  /// What a fresh analysis says: dropped nodes held, without load.
  [[nodiscard]] std::unique_ptr<StaticSolution> fresh() const {
    FrameModel model = model_;
    LoadSet loads;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      if (left_[n] != 0) model.supports.push_back({static_cast<int>(n), fixed()});
      if (left_[n] == 0) loads.nodes.push_back({static_cast<int>(n), node_load_[n]});
    }
    for (std::size_t i = 0; i < model.beams.size(); ++i) {
      Beam& b = model.beams[i];
      bool gone = false;
      for (std::size_t e = 0; e < 2; ++e)
        gone |= left_[static_cast<std::size_t>(b.node[e])] != 0 && !b.end_stiffness[e].isZero(0);
      if (gone || (b.end_stiffness[0].isZero(0) && b.end_stiffness[1].isZero(0))) {
        b.end_stiffness = {Vec6::Zero(), Vec6::Zero()};
        continue;
      }
      loads.beams.push_back(weight_[i]);
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
      return std::make_unique<StaticSolution>(analysis.solve(std::span(&loads, 1)).front());
    } catch (const Instability&) {
      return nullptr;
    }
  }

  /// Lets go of what moves.
  void drop(const Mechanism& mechanism) {
    for (const int node : mechanism.nodes) left_[static_cast<std::size_t>(node)] = 1;
    for (const int beam : mechanism.beams)
      for (int end = 0; end < 2; ++end) set_end(beam, end, Vec6::Zero());
    standing->drop_nodes(mechanism.nodes);
  }

  [[nodiscard]] double difference(const StaticSolution& fresh) const {
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
      largest = std::max(largest, fresh.displacements[n].norm());
      difference = std::max(difference, (fresh.displacements[n] - standing->displacements()[n]).norm());
    }
    return largest > 0 ? difference / largest : difference;
  }

  void set_end(int beam, int end, const Vec6& stiffness) {
    model_.beams[static_cast<std::size_t>(beam)].end_stiffness[static_cast<std::size_t>(end)] = stiffness;
    standing->set_end_stiffness(beam, end, stiffness);
  }

  /// The structure stands, and its answer is the fresh one.
  void check(Tally& tally) {
    REQUIRE(standing->solve().stable);
    const auto answer = fresh();
    REQUIRE(answer != nullptr);
    CHECK(difference(*answer) < tolerance(answer->quality.condition));
    ++tally.answers;
  }

  std::unique_ptr<Reanalysis> standing;

 private:
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

  std::mt19937 random_;
  std::uniform_real_distribution<double> share_{0, 1};
  FrameModel model_;
  std::vector<BeamLoad> weight_;
  std::vector<char> left_;
  std::vector<Vec6> node_load_;
  std::map<int, double> factors_;
  std::set<int> gone_shells_;
};

void follow(RandomFrame& frame, int changes, Tally& tally) {
  for (int i = 0; i < changes; ++i) {
    frame.change();
    for (int release = 0;; ++release) {
      const ReanalysisAnswer& answer = frame.standing->solve();
      const auto fresh = frame.fresh();
      INFO("change " << i << ", release " << release);
      REQUIRE(answer.stable == (fresh != nullptr));
      if (answer.stable) {
        CHECK(frame.difference(*fresh) < tolerance(fresh->quality.condition));
        CHECK(answer.quality.backward_error < 1e-13);
        ++tally.answers;
        break;
      }
      ++tally.mechanisms;
      REQUIRE(answer.mechanism.nodes.size() + answer.mechanism.beams.size() > 0);
      REQUIRE(release < 200);
      frame.drop(answer.mechanism);
    }
  }
}

}  // namespace

TEST_CASE("random changes give the answers of fresh analyses, and no mechanism is missed or invented") {
  Tally tally;
  std::uint64_t low_rank = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    RandomFrame frame(2 + static_cast<int>(seed % 3), 3 + static_cast<int>(seed % 4), seed, seed % 2 == 0);
    INFO("seed " << seed);
    follow(frame, 60, tally);
    low_rank += frame.standing->counters().low_rank;
  }
  CHECK(tally.answers == 12 * 60);
  CHECK(tally.mechanisms > 20);
  CHECK(low_rank > 300);
}

TEST_CASE("breaking and restoring a joint returns to the very same answer") {
  RandomFrame frame(3, 5, 7);
  REQUIRE(frame.standing->solve().stable);
  const std::vector<Vec6> before = frame.standing->displacements();
  frame.standing->set_end_stiffness(17, 0, Vec6::Zero());
  REQUIRE(frame.standing->solve().stable);
  const std::vector<Vec6> broken = frame.standing->displacements();
  frame.standing->set_end_stiffness(17, 0, fixed());
  REQUIRE(frame.standing->solve().stable);
  double moved = 0;
  for (std::size_t n = 0; n < before.size(); ++n) {
    CHECK(before[n] == frame.standing->displacements()[n]);
    moved = std::max(moved, (before[n] - broken[n]).norm());
  }
  CHECK(moved > 1e-6);
  CHECK(frame.standing->counters().refactorisations == 0);
  CHECK(frame.standing->counters().low_rank == 2);
}

TEST_CASE("joints broken and restored many times over cost no more, and are not forgotten") {
  RandomFrame frame(3, 4, 5);
  REQUIRE(frame.standing->solve().stable);
  const int beams = static_cast<int>(frame.standing->model().beams.size());
  Tally tally;
  for (int round = 0; round < 3; ++round) {
    for (int beam = 0; beam < beams; ++beam) {
      frame.set_end(beam, 1, Vec6::Zero());
      frame.check(tally);
      frame.set_end(beam, 1, fixed());
      frame.check(tally);
      // Broken again at once, and then another one before the first is restored.
      frame.set_end(beam, 1, Vec6::Zero());
      frame.check(tally);
      frame.set_end((beam + 7) % beams, 1, Vec6::Zero());
      frame.check(tally);
      frame.set_end(beam, 1, fixed());
      frame.set_end((beam + 7) % beams, 1, fixed());
    }
  }
  CHECK(tally.answers == 3 * 4 * beams);
  CHECK(frame.standing->counters().refactorisations == 0);
}

TEST_CASE("few broken joints are corrected, many are factorised anew") {
  RandomFrame frame(4, 8, 3);
  REQUIRE(frame.standing->solve().stable);
  frame.standing->set_end_stiffness(100, 0, Vec6::Zero());
  REQUIRE(frame.standing->solve().stable);
  CHECK(frame.standing->counters().refactorisations == 0);
  // Every third beam a tenth softer: nothing falls, and far too many columns for a correction.
  for (int beam = 0; beam < static_cast<int>(frame.standing->model().beams.size()); beam += 3)
    frame.standing->set_beam_stiffness_factor(beam, 0.9);
  REQUIRE(frame.standing->solve().stable);
  CHECK(frame.standing->counters().refactorisations == 1);
}

TEST_CASE("long random sequences on frames of all sizes", "[.stress]") {
  Tally tally;
  ReanalysisCounters sum;
  for (unsigned seed = 100; seed < 160; ++seed) {
    const int posts = 2 + static_cast<int>(seed % 4), storeys = seed % 10 == 0 ? 33 : 3 + static_cast<int>(seed % 7);
    RandomFrame frame(posts, storeys, seed, seed % 3 == 0);
    INFO("seed " << seed << ", " << posts << " x " << posts << " posts, " << storeys << " storeys");
    follow(frame, 100, tally);
    const ReanalysisCounters& c = frame.standing->counters();
    sum.low_rank += c.low_rank;
    sum.refactorisations += c.refactorisations;
    sum.load_solves += c.load_solves;
  }
  WARN(tally.answers << " answers, " << tally.mechanisms << " mechanisms; " << sum.low_rank << " corrections, "
                     << sum.refactorisations << " new factors, " << sum.load_solves << " loads");
  CHECK(tally.answers == 60 * 100);
  CHECK(tally.mechanisms > 100);
}
