// States of frames that move under random changes: one that is loaded goes on as the one that was saved, to the bit.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <memory>

#include "random_frame.h"
#include "record.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

using Impulse = FrameDynamics::Impulse;

/// Ends that break by their largest moment, and hinges at the feet of some posts.
class MomentLaw : public JointLaw {
 public:
  MomentLaw(double capacity, std::vector<PlasticHinge> hinges) : capacity_(capacity), hinges_(std::move(hinges)) {}
  [[nodiscard]] double beam_utilisation(int beam, const Vec12& forces) const override {
    return std::max(end_utilisation(beam, 0, forces), end_utilisation(beam, 1, forces));
  }
  [[nodiscard]] double end_utilisation(int, int end, const Vec12& forces) const override {
    return forces.segment<3>(6 * end + 3).cwiseAbs().maxCoeff() / capacity_;
  }
  [[nodiscard]] std::span<const PlasticHinge> plastic_hinges() const override { return hinges_; }

 private:
  double capacity_;
  std::vector<PlasticHinge> hinges_;
};

using Step = std::function<void(FrameDynamics&, Record&)>;

void read_energy(const FrameDynamics& frame, Record& record) {
  const DynamicEnergy& e = frame.energy();
  for (const double number :
       {e.kinetic, e.elastic, e.damped, e.numerical, e.dissipated, e.struck, e.external_work, e.freed})
    record.add(number);
}

void read_counters(const FrameDynamics& frame, Record& record) {
  const DynamicCounters& d = frame.counters();
  const ReanalysisCounters& c = frame.reanalysis_counters();
  for (const std::uint64_t count : {d.substeps, d.retaken, d.breaks, d.yielding, d.unsettled, d.divided, c.low_rank,
                                    c.refactorisations, c.orderings, c.background_factors})
    record.add(static_cast<double>(count));
}

void read_reactions(const FrameDynamics& frame, Record& record) {
  for (int i = 0; i < static_cast<int>(frame.model().supports.size()); ++i) record.add(frame.reaction(i));
}

/// All but reactions.
void read_frame(const FrameDynamics& frame, Record& record) {
  record.add(frame.time());
  record.add(frame.displacements());
  record.add(frame.velocities());
  record.add(frame.accelerations());
  for (int beam = 0; beam < static_cast<int>(frame.model().beams.size()); ++beam) {
    record.add(frame.beam_end_forces(beam));
    record.add(frame.beam_end_force_rates(beam));
    record.add(frame.beam_course(beam).at(0.3));
    record.add(frame.plastic_rotations(beam));
    record.add(frame.beam_momentum(beam));
  }
  for (int node = 0; node < static_cast<int>(frame.model().nodes.size()); ++node) {
    record.add(frame.node_course(node).at(0.7));
    record.add(frame.node_momentum(node));
  }
  for (int i = 0; i < static_cast<int>(frame.model().patches.size()); ++i) record.add(frame.patch_momentum(i));
  for (int i = 0; i < static_cast<int>(frame.model().shells.size()); ++i) {
    const std::array<Vec6, 4> corners = frame.shell_corner_forces(i, true);
    for (const Vec6& force : corners) record.add(force);
  }
  record.add(frame.momentum());
  record.add(frame.mass_damping());
  record.add(frame.rayleigh_quotient(frame.displacements()));
  read_energy(frame, record);
  read_counters(frame, record);
}

/// Random things to do with a frame that moves.
class Changes {
 public:
  /// `divided`: substeps may be, and no loads go with time.
  Changes(FrameModel model, const JointLaw& law, bool divided, unsigned seed)
      : model_(std::move(model)), law_(law), divided_(divided), random_(seed) {}

  Step next() {
    switch (pick(25)) {
      case 0:
        return change(
            [beam = beam(), end = pick(2), to = stiffness()](FrameDynamics& f) { f.set_end_stiffness(beam, end, to); });
      case 1:
        return pick(2) == 0 ? next() : change([beam = beam()](FrameDynamics& f) { f.remove_beam(beam); });
      case 2:
        return change_plate();
      case 3:
        return change(
            [beam = beam(), factor = 0.5 + share()](FrameDynamics& f) { f.set_beam_stiffness_factor(beam, factor); });
      case 4:
        return change(
            [beam = beam(), density = 8e3 * share()](FrameDynamics& f) { f.set_beam_density(beam, density); });
      case 5:
        return change([support = pick(model_.supports.size()), to = support()](FrameDynamics& f) {
          f.set_support_stiffness(support, to);
        });
      case 6:
        return change_load();
      case 7:
        return turn();
      case 8:
        return change_damping();
      case 9:
        return add_pattern();
      case 10:
        return change_pattern();
      case 11:
        return strike();
      case 12:
        return answer_impulses();
      case 13:
        return look();
      case 14:
        return release_node();
      default:
        return advance();
    }
  }

 private:
  int pick(std::size_t count) { return static_cast<int>(random_() % count); }
  double share() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  int beam() { return pick(model_.beams.size()); }
  int node() { return pick(model_.nodes.size()); }
  Vec6 stiffness() { return pick(2) == 0 ? Vec6(Vec6::Zero()) : components(rigid, rigid, rigid, rigid, 1e7, 1e7); }
  Vec6 support() { return pick(4) == 0 ? fixed() : Vec6(Vec6::Constant(1e7 + 1e8 * share())); }
  std::vector<Impulse> impulses() { return {{node(), unit(pick(6), 500 * share())}, {node(), unit(pick(3), 500)}}; }

  template <class Change>
  static Step change(Change made) {
    return [made](FrameDynamics& frame, Record&) { made(frame); };
  }

  /// Nothing keeps it from turning, or at all.
  Step release_node() {
    const Vec6 to = pick(2) == 0 ? pinned() : Vec6(Vec6::Zero());
    return change([node = node(), to](FrameDynamics& f) {
      for (int i = 0; i < static_cast<int>(f.model().beams.size()); ++i)
        for (int end = 0; end < 2; ++end)
          if (f.model().beams[static_cast<std::size_t>(i)].node[static_cast<std::size_t>(end)] == node)
            f.set_end_stiffness(i, end, to);
    });
  }
  Step change_plate() {
    if (!model_.shells.empty() && pick(2) == 0) {
      const int shell = pick(model_.shells.size());
      if (pick(2) == 0) return change([shell](FrameDynamics& f) { f.remove_shell(shell); });
      const Eigen::MatrixXd K = (1e8 * (0.1 + share()) * patch_of_springs(4, 1));
      return change([shell, K](FrameDynamics& f) { f.set_shell_stiffness(shell, K); });
    }
    if (model_.patches.empty()) return next();
    if (pick(2) == 0)
      return change([k = 1e7 * share()](FrameDynamics& f) { f.set_patch_stiffness(0, patch_of_springs(3, k)); });
    return change(
        [m = 1e3 * share()](FrameDynamics& f) { f.set_patch_mass(0, m * Eigen::MatrixXd::Identity(18, 18)); });
  }
  Step change_load() {
    const int i = beam();
    const double length = model_.beams[static_cast<std::size_t>(i)].length;
    if (pick(2) == 0)
      return change([node = node(), load = Vec6(unit(pick(3), 2e4 * share()))](FrameDynamics& f) {
        f.set_node_load(node, load);
      });
    return change([i, load = uniform_load(i, length, unit(pick(3), -4e3 * share()))](FrameDynamics& f) {
      f.set_beam_loads(i, {load});
    });
  }
  Step turn() {
    const int i = beam(), end = pick(2), component = 3 + pick(3), kind = pick(4);
    return change([i, end, component, kind, angle = 1e-3 * (share() - 0.5)](FrameDynamics& f) {
      if (kind == 0) f.set_plastic_rotation(i, end, component, angle);
      if (kind == 1) f.turn_at_once(i, end, component, angle, 10);
      if (kind == 2) f.add_momentum(i, unit(0, 50));
      if (kind == 3) f.set_state(f.displacements(), f.velocities());
    });
  }
  Step change_damping() {
    return change([a0 = share(), a1 = 1e-3 * share(), mass_alone = pick(3) != 0](FrameDynamics& f) {
      mass_alone ? f.set_mass_damping(a0) : f.set_damping({a0, a1});
    });
  }
  Step add_pattern() {
    if (divided_) return next();
    LoadSet loads;
    loads.nodes.push_back({node(), unit(pick(3), 1e3)});
    loads.beams.push_back(point_load(beam(), 1, unit(pick(3), 1e3)));
    ++patterns_;
    return [loads, kind = pick(3)](FrameDynamics& f, Record&) {
      if (kind == 0) (void)f.add_pattern(loads);
      if (kind == 1) (void)f.add_ground_acceleration(Vec3(1, 0.5, 0));
      if (kind == 2) (void)f.add_holding_force();
    };
  }
  Step change_pattern() {
    if (patterns_ == 0) return next();
    return change([which = pick(static_cast<std::size_t>(patterns_)), value = share(), at_once = pick(2) == 0](
                      FrameDynamics& f) { at_once ? f.jump_pattern(which, value) : f.set_pattern(which, value); });
  }
  Step strike() {
    return change(
        [some = impulses(), now = pick(2) == 0](FrameDynamics& f) { now ? f.strike(some) : f.add_impulses(some); });
  }
  Step answer_impulses() {
    return [some = impulses(), others = impulses(), kind = pick(4)](FrameDynamics& f, Record& record) {
      const std::vector<std::vector<Impulse>> both{some, others};
      const int nodes[] = {some.front().node};
      if (kind == 0) record.add(f.velocities_of(some));
      if (kind == 1) record.add(f.mobility(both));
      if (kind == 2) record.add(f.local_modes(nodes, both).squared);
      if (kind == 3) record.add(f.foresee());
    };
  }
  Step look() {
    return [kind = pick(4)](FrameDynamics& f, Record& record) {
      if (kind == 0) read_frame(f, record);
      if (kind == 1) record.add(f.work_of_present_loads());
      if (kind == 2) record.add(f.geometric_work_to(f.displacements()));
      if (kind == 3) read_reactions(f, record);
    };
  }
  Step advance() {
    return [&law = law_, substeps = 1 + pick(3)](FrameDynamics& f, Record& record) {
      for (int n = 0; n < substeps; ++n) {
        for (const JointBreak& broken : f.advance(&law)) {
          record.add(broken.beam);
          record.add(broken.time);
          record.add(broken.forces);
        }
        record.add(f.displacements());
        read_energy(f, record);
      }
      read_counters(f, record);
    };
  }

  FrameModel model_;
  const JointLaw& law_;
  bool divided_;
  std::mt19937 random_;
  int patterns_ = 0;
};

struct History {
  FrameModel model;
  MassModel masses;
  DynamicOptions options;
  std::unique_ptr<MomentLaw> law;
  std::vector<Step> steps;
  [[nodiscard]] std::unique_ptr<FrameDynamics> begin() const {
    return std::make_unique<FrameDynamics>(model, masses, options);
  }
};

History history(unsigned seed) {
  std::mt19937 random(seed);
  History result;
  const FrameParts parts{seed % 2 == 0, seed % 3 == 0, seed % 5 == 0};
  result.model = random_frame(2, 3 + static_cast<int>(seed % 3), parts, random);
  if (parts.patch) result.model.patches[0].mass = 500 * Eigen::MatrixXd::Identity(18, 18);
  for (int n = 0; n < static_cast<int>(result.model.nodes.size()); n += 2)
    result.masses.nodes.push_back({n, 2000, Vec3(10, 10, 10)});
  result.options.spectral_radius = seed % 3 == 0 ? 1 : 0.8;
  result.options.second_order = seed % 4 == 1;
  result.options.keep_energy = seed % 7 != 0;
  if (seed % 3 != 2) result.options.damping = {0.5, 1e-3};
  const bool divided = seed % 6 == 5;
  if (divided) {
    result.options.most_parts = 4;
    result.options.largest_error = 0.02;
  }
  if (seed % 4 == 3) result.options.analysis.factorisation = Factorisation::simplicial;
  std::vector<PlasticHinge> hinges;
  for (int post = 0; post < 4; ++post) hinges.push_back({post, 0, 4 + post % 2, 3e3, 0.01});
  result.law = std::make_unique<MomentLaw>(3e4, hinges);
  Changes changes(result.model, *result.law, divided, seed + 1000);
  constexpr int steps = 70;
  for (int i = 0; i < steps; ++i) result.steps.push_back(changes.next());
  result.steps.push_back([](FrameDynamics& frame, Record& record) {
    read_frame(frame, record);
    read_reactions(frame, record);
    record.add(frame.work_of_present_loads());
  });
  return result;
}

/// Whether the step was done. What a frame cannot stand ends its history.
bool take(const Step& step, FrameDynamics& frame, Record& record) {
  try {
    step(frame, record);
  } catch (const Instability&) {
    return false;
  }
  return true;
}

}  // namespace

TEST_CASE("A frame in motion that is loaded at any moment goes on as the one that was saved") {
  DynamicCounters seen;
  std::uint64_t corrections = 0, factors = 0, steps = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    INFO("seed " << seed);
    const History whole = history(seed);
    const auto plain = whole.begin(), saved = whole.begin();
    std::vector<Record> expected, looks;
    for (const Step& step : whole.steps) {
      read_frame(*plain, looks.emplace_back());
      if (!take(step, *plain, expected.emplace_back())) break;
    }
    std::vector<std::string> moments;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      moments.push_back(bytes_of(*saved));
      REQUIRE(bytes_of(*saved) == moments.back());
      Record record;
      (void)take(whole.steps[i], *saved, record);
      INFO("saving changed step " << i);
      REQUIRE(record == expected[i]);
    }
    const std::string last = bytes_of(*saved);
    std::mt19937 random(seed);
    const auto used_before = whole.begin();
    for (int load = 0; load < 6; ++load) {
      const std::size_t at = random() % moments.size();
      const auto fresh = whole.begin();
      FrameDynamics& loaded = load % 2 == 0 ? *fresh : *used_before;
      INFO("loaded before step " << at);
      load_bytes(loaded, moments[at]);
      Record look;
      read_frame(loaded, look);
      REQUIRE(look == looks[at]);
      load_bytes(loaded, moments[at]);
      REQUIRE(bytes_of(loaded) == moments[at]);
      for (std::size_t i = at; i < expected.size(); ++i) {
        Record record;
        (void)take(whole.steps[i], loaded, record);
        INFO("step " << i);
        REQUIRE(record == expected[i]);
      }
      REQUIRE(bytes_of(loaded) == last);
    }
    steps += expected.size();
    seen.breaks += plain->counters().breaks;
    seen.yielding += plain->counters().yielding;
    seen.divided += plain->counters().divided;
    corrections += plain->reanalysis_counters().low_rank;
    factors += plain->reanalysis_counters().orderings + plain->reanalysis_counters().refactorisations;
  }
  CHECK(steps > 2000);
  CHECK(seen.breaks > 50);
  CHECK(seen.yielding > 50);
  CHECK(seen.divided > 50);
  CHECK(corrections > 200);
  CHECK(factors > 100);
}

TEST_CASE("A frame in motion whose bytes end too soon is not loaded") {
  const History whole = history(8);
  const auto saved = whole.begin();
  Record record;
  for (const Step& step : whole.steps)
    if (!take(step, *saved, record)) break;
  const std::string bytes = bytes_of(*saved);
  for (const double share : {0.0, 0.1, 0.5, 0.9, 0.999}) {
    const auto cut = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
    const auto loaded = whole.begin();
    CHECK_THROWS_AS(load_bytes(*loaded, bytes.substr(0, cut)), std::runtime_error);
  }
}
