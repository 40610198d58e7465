// States of structures under random changes: one that is loaded goes on as the one that was saved, to the bit.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <memory>

#include "joint_uses.h"
#include "random_frame.h"
#include "record.h"

using namespace topple::test;

namespace {

/// An analysis with the watch of its selective answers, whose readings are the caller's to keep.
struct Subject {
  Subject(const FrameModel& model, const AnalysisOptions& options, const RefreshRules& rules)
      : standing(model, options), uses(standing, std::vector<Vec6>(model.beams.size(), Vec6::Constant(3e5))) {
    standing.set_refresh(rules);
  }
  Reanalysis standing;
  JointUtilisations uses;
};

using Step = std::function<void(Subject&, Record&)>;

void read_counters(const Reanalysis& standing, Record& record) {
  const ReanalysisCounters& c = standing.counters();  // late factors apart: they go by the clock
  for (const std::uint64_t count : {c.solves, c.unchanged, c.load_solves, c.low_rank, c.refactorisations, c.orderings,
                                    c.background_factors, c.selective, c.beams_visited, c.beams_left})
    record.add(static_cast<double>(count));
}

void read_answer(const ReanalysisAnswer& answer, const Reanalysis& standing, Record& record) {
  record.add(answer.stable);
  record.add(answer.nearly_unstable);
  record.add(answer.mechanism.motion);
  const SolveQuality& q = answer.quality;
  for (const double number : {q.backward_error, q.condition, q.error_bound, static_cast<double>(q.refinements)})
    record.add(number);
  const SelectiveEffort& e = standing.selective_effort();
  for (const double number : {e.visited_entries, e.energy, e.energy_left_out, e.largest_left_out}) record.add(number);
  record.add(standing.last_operations());
  record.add(standing.uses_known());
  read_counters(standing, record);
}

void read_reactions(const Reanalysis& standing, Record& record) {
  for (std::size_t i = 0; i < standing.model().supports.size(); ++i) record.add(standing.reaction(static_cast<int>(i)));
}

/// All but reactions.
void read_structure(const Reanalysis& standing, Record& record) {
  record.add(standing.last_operations());
  record.add(standing.selective_effort().largest_left_out);
  record.add(standing.displacements());
  for (std::size_t i = 0; i < standing.model().beams.size(); ++i)
    record.add(standing.beam_end_forces(static_cast<int>(i)));
  for (std::size_t i = 0; i < standing.model().shells.size(); ++i) {
    const std::array<Vec6, 4> corners = standing.shell_corner_forces(static_cast<int>(i));
    for (const Vec6& force : corners) record.add(force);
  }
  for (std::size_t i = 0; i < standing.model().patches.size(); ++i)
    record.add(standing.patch_forces(static_cast<int>(i)));
  record.add(standing.strain_energy());
}

/// Random things to do with a structure, chosen before it is known how it answers.
class Changes {
 public:
  Changes(FrameModel model, unsigned seed) : model_(std::move(model)), random_(seed) {}

  Step next() {
    switch (pick(19)) {
      case 0:
      case 1:
        return change(
            [beam = beam(), end = pick(2), to = stiffness()](Reanalysis& r) { r.set_end_stiffness(beam, end, to); });
      case 2:
        return change(
            [beam = beam(), back = pick(2) == 0](Reanalysis& r) { back ? r.restore_beam(beam) : r.remove_beam(beam); });
      case 3:
        return change(
            [beam = beam(), factor = 0.1 + share()](Reanalysis& r) { r.set_beam_stiffness_factor(beam, factor); });
      case 4:
        return change([support = pick(model_.supports.size()), to = support()](Reanalysis& r) {
          r.set_support_stiffness(support, to);
        });
      case 5:
      case 14:
        return model_.shells.empty() ? next() : change_shell();
      case 6:
        return model_.patches.empty() ? next() : change_patch();
      case 7:
        return change(
            [node = node(), load = Vec6(unit(pick(3), 1e4 * share()))](Reanalysis& r) { r.set_node_load(node, load); });
      case 8:
        return change_beam_load();
      case 9:
        return pick(3) == 0 ? change_much() : next();
      case 10:
        return respond();
      case 11:
        return look();
      case 12:
        return lose_one_at_a_time();
      case 13:
        return release_node();
      default:
        return solve();
    }
  }

 private:
  int pick(std::size_t count) { return static_cast<int>(random_() % count); }
  double share() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  int beam() { return pick(model_.beams.size()); }
  int node() { return pick(model_.nodes.size()); }
  Vec6 stiffness() {
    const int kind = pick(4);
    if (kind == 0) return fixed();
    if (kind == 1) return components(rigid, rigid, rigid, rigid, 0, 1e6 * share());
    return Vec6::Zero();
  }
  /// Mostly springs; else the equations are others.
  Vec6 support() { return pick(4) == 0 ? fixed() : Vec6(Vec6::Constant(1e6 + 1e8 * share())); }

  template <class Change>
  static Step change(Change made) {
    return [made](Subject& subject, Record&) { made(subject.standing); };
  }

  /// Nothing keeps it from turning, or at all.
  Step release_node() {
    const Vec6 to = pick(2) == 0 ? pinned() : Vec6(Vec6::Zero());
    return change([node = node(), to](Reanalysis& r) {
      for (int i = 0; i < static_cast<int>(r.model().beams.size()); ++i)
        for (int end = 0; end < 2; ++end)
          if (r.model().beams[static_cast<std::size_t>(i)].node[static_cast<std::size_t>(end)] == node)
            r.set_end_stiffness(i, end, to);
    });
  }
  Step change_shell() {
    const int shell = pick(model_.shells.size()), kind = pick(4);
    return change([shell, kind, factor = 0.2 + share()](Reanalysis& r) {
      if (kind == 0) r.restore_shell(shell);
      if (kind == 1) r.set_shell_stiffness(shell, factor * r.shell_stiffness(shell));
      if (kind > 1) r.remove_shell(shell);
    });
  }
  Step change_patch() {
    const int patch = pick(model_.patches.size());
    return change([patch, stiffness = 1e7 * share()](Reanalysis& r) {
      r.set_patch_stiffness(patch, patch_of_springs(3, stiffness));
    });
  }
  Step change_beam_load() {
    const int i = beam();
    const double length = model_.beams[static_cast<std::size_t>(i)].length;
    const std::vector<BeamLoad> loads{uniform_load(i, length, unit(pick(3), -4e3 * share())),
                                      point_load(i, length * share(), unit(pick(6), 1e3))};
    return change([i, loads](Reanalysis& r) { r.set_beam_loads(i, loads); });
  }
  Step change_much() {
    std::vector<std::pair<int, double>> factors;
    for (int i = 0; i < static_cast<int>(model_.beams.size()); i += 1 + pick(3)) factors.emplace_back(i, 0.5 + share());
    return change([factors](Reanalysis& r) {
      for (const auto& [beam, factor] : factors) r.set_beam_stiffness_factor(beam, factor);
    });
  }

  /// What cannot stand leaves, mostly.
  Step solve() {
    const bool in_part = model_.patches.empty() && pick(2) == 0, lets_go = pick(4) != 0;
    return [in_part, lets_go](Subject& subject, Record& record) {
      Reanalysis& r = subject.standing;
      constexpr int most_releases = 20;
      for (int release = 0; release < most_releases; ++release) {
        const ReanalysisAnswer answer = in_part ? r.solve(subject.uses) : r.solve();
        read_answer(answer, r, record);
        if (answer.stable || !lets_go) break;
        for (const int beam : answer.mechanism.beams)
          for (int end = 0; end < 2; ++end) r.set_end_stiffness(beam, end, Vec6::Zero());
        r.drop_nodes(answer.mechanism.nodes);
      }
    };
  }
  Step respond() {
    LoadSet loads;
    loads.nodes.push_back({node(), unit(pick(3), 1e3)});
    loads.beams.push_back(point_load(beam(), 1, unit(pick(3), 1e3)));
    return [loads](Subject& subject, Record& record) {
      try {
        const Reanalysis::Response response = subject.standing.respond(loads);
        record.add(response.displacements);
        record.add(response.backward_error);
        std::vector<char> known;
        record.add(subject.standing.respond_near(loads, known).displacements);
      } catch (const Instability&) {
        record.add(-1.0);
      }
    };
  }
  Step look() {
    const int kind = pick(6), somewhere = node();
    return [kind, somewhere](Subject& subject, Record& record) {
      Reanalysis& r = subject.standing;
      if (kind == 0) read_structure(r, record);
      if (kind == 1) record.add(r.displacements_at(std::span(&somewhere, 1))[static_cast<std::size_t>(somewhere)]);
      if (kind == 2) r.complete(&subject.uses);
      if (kind == 3) r.forget_references();
      if (kind == 4) r.forget_utilisations();
      if (kind == 5) read_reactions(r, record);
    };
  }
  Step lose_one_at_a_time() {
    std::vector<int> beams;
    for (int i = 0; i < 4; ++i) beams.push_back(beam());
    const int stage = pick(3);
    return [beams, stage](Subject& subject, Record& record) {
      Reanalysis& r = subject.standing;
      if (stage == 0) r.expect_losses(beams);
      for (const int beam : beams) {
        if (stage == 0) break;  // what was found beforehand is used after the state was saved
        r.remove_beam(beam);
        read_answer(r.solve(), r, record);
        r.restore_beam(beam);
        read_answer(r.solve(), r, record);
      }
    };
  }

  FrameModel model_;
  std::mt19937 random_;
};

struct History {
  FrameModel model;
  AnalysisOptions options;
  RefreshRules rules;
  std::vector<Step> steps;
  [[nodiscard]] std::unique_ptr<Subject> begin() const { return std::make_unique<Subject>(model, options, rules); }
};

History history(unsigned seed) {
  std::mt19937 random(seed);
  History result;
  const FrameParts parts{seed % 2 == 0, seed % 3 == 0, seed % 5 == 0};
  result.model = random_frame(2 + static_cast<int>(seed % 2), 4 + static_cast<int>(seed % 3), parts, random);
  constexpr std::array kinds{Factorisation::automatic, Factorisation::automatic, Factorisation::simplicial,
                             Factorisation::supernodal};
  result.options.factorisation = kinds[seed % kinds.size()];
  result.options.threads = 1 + static_cast<int>(seed % 2);
  if (seed % 3 != 1) {  // factors in the background, even of small frames
    result.rules.columns = 12;
    result.rules.least_operations = 0;
    result.rules.share = 0.5 + 2 * (seed % 4);
  }
  Changes changes(result.model, seed + 1000);
  constexpr int steps = 80;
  for (int i = 0; i < steps; ++i) result.steps.push_back(changes.next());
  result.steps.push_back([](Subject& subject, Record& record) {
    read_answer(subject.standing.solve(), subject.standing, record);
    read_structure(subject.standing, record);
    read_reactions(subject.standing, record);
  });
  return result;
}

/// What is read of each of the steps from one on; in `looks` (unless null) what could be read before each.
std::vector<Record> go_on(Subject& subject, const History& history, std::size_t from = 0,
                          std::vector<Record>* looks = nullptr) {
  std::vector<Record> records;
  for (std::size_t i = from; i < history.steps.size(); ++i) {
    if (looks != nullptr) read_structure(subject.standing, looks->emplace_back());
    history.steps[i](subject, records.emplace_back());
  }
  return records;
}

struct Moment {
  std::string bytes;
  std::vector<std::array<double, 2>> uses;
};

}  // namespace

TEST_CASE("A structure that is loaded at any moment of its history answers from there on as the one that was saved") {
  ReanalysisCounters seen;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    INFO("seed " << seed);
    const History whole = history(seed);
    const auto plain = whole.begin(), saved = whole.begin();
    std::vector<Record> looks;
    const std::vector<Record> expected = go_on(*plain, whole, 0, &looks);
    std::vector<Moment> moments;
    for (std::size_t i = 0; i < whole.steps.size(); ++i) {
      moments.push_back({bytes_of(saved->standing), saved->uses.use});
      REQUIRE(bytes_of(saved->standing) == moments.back().bytes);
      Record record;
      whole.steps[i](*saved, record);
      INFO("saving changed step " << i);
      REQUIRE(record == expected[i]);
    }
    const std::string last = bytes_of(saved->standing);
    std::mt19937 random(seed);
    auto used_before = whole.begin();
    for (int load = 0; load < 6; ++load) {
      const std::size_t at = random() % moments.size();
      auto fresh = whole.begin();
      Subject& loaded = load % 2 == 0 ? *fresh : *used_before;
      INFO("loaded before step " << at);
      load_bytes(loaded.standing, moments[at].bytes);
      Record look;
      read_structure(loaded.standing, look);
      REQUIRE(look == looks[at]);
      load_bytes(loaded.standing, moments[at].bytes);
      loaded.uses.use = moments[at].uses;
      REQUIRE(bytes_of(loaded.standing) == moments[at].bytes);
      const std::vector<Record> records = go_on(loaded, whole, at);
      for (std::size_t i = 0; i < records.size(); ++i) {
        INFO("step " << at + i);
        REQUIRE(records[i] == expected[at + i]);
      }
      if (loaded.standing.counters().late_factors == saved->standing.counters().late_factors)
        REQUIRE(bytes_of(loaded.standing) == last);
    }
    const ReanalysisCounters& c = plain->standing.counters();
    seen.low_rank += c.low_rank;
    seen.orderings += c.orderings;
    seen.refactorisations += c.refactorisations;
    seen.background_factors += c.background_factors;
    seen.selective += c.selective;
  }
  CHECK(seen.low_rank > 200);
  CHECK(seen.orderings > 100);
  CHECK(seen.refactorisations > 100);
  CHECK(seen.background_factors > 20);
  CHECK(seen.selective > 30);
}

TEST_CASE("A structure whose bytes end too soon is not loaded") {
  const History whole = history(6);
  const auto saved = whole.begin();
  (void)go_on(*saved, whole);
  const std::string bytes = bytes_of(saved->standing);
  for (const double share : {0.0, 0.1, 0.5, 0.9, 0.999}) {
    const auto cut = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
    const auto loaded = whole.begin();
    CHECK_THROWS_AS(load_bytes(loaded->standing, bytes.substr(0, cut)), std::runtime_error);
  }
}
