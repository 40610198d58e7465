#include "goes_on_alike.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

#include "topple/structure/collapse_report.h"

namespace topple::test {

using namespace structure;

std::string state_of(const Simulation& simulation) {
  std::ostringstream bytes;
  simulation.save_state(bytes);
  return std::move(bytes).str();
}

void load(Simulation& simulation, const std::string& state) {
  std::istringstream bytes(state);
  simulation.load_state(bytes);
}

namespace {

/// Numbers as they are, to the bit.
class Seen {
 public:
  Seen() { text_ << std::hexfloat; }
  template <class... T>
  void line(const T&... values) {
    ((add(values), text_ << ' '), ...);
    text_ << '\n';
  }
  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T value) { text_ << value; }
  void add(std::string_view text) { text_ << text; }
  template <class Tag>
  void add(const Id<Tag>& id) {
    text_ << id.index;
  }
  void add(const collision::BodyId& id) { text_ << id.value; }
  template <class Derived>
  void add(const Eigen::MatrixBase<Derived>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) text_ << matrix(i) << ' ';
  }
  template <class A, class B>
  void add(const std::pair<A, B>& pair) {
    add(pair.first), text_ << ':', add(pair.second);
  }
  template <class T>
  requires requires(const T& list) { list.begin(); }
  void add(const T& list) {
    for (const auto& one : list) add(one), text_ << ' ';
  }
  void add(const Utilisation& used) {
    text_ << used.value << ' ' << static_cast<int>(used.sense) << ' ' << used.demand;
  }
  std::ostringstream text_;
};

void see_accounts(Seen& seen, const Simulation& simulation) {
  for (const SimulationEvent& event : simulation.events()) {
    seen.line(event_line(simulation.building(), event), event.position, event.joint.demand, event.joint.energy,
              event.peak_force, event.speed_in, event.speed_out, event.body, event.other_body, event.members,
              event.panels);
  }
  for (const auto& [name, value] : ledger_entries(simulation.ledger())) seen.line(name, value);
  seen.line(simulation.ledger().momentum_error);
  const SimulationCounters& c = simulation.counters();
  seen.line(c.steps_idle, c.solves, c.low_rank, c.refactorisations, c.segmentations, c.collision_steps,
            c.contacts_ignored, c.impacts_bounded, c.impacts_together, c.selective, c.background_factors);
  const BodyOverlaps& overlaps = simulation.overlaps();
  seen.line(overlaps.deep, overlaps.depth, overlaps.thickness, overlaps.time, overlaps.body, overlaps.with);
  seen.line(simulation.finished(), simulation.at_rest(), simulation.save().actions.size(), simulation.save().scene);
}

void see_what_stands(Seen& seen, const Simulation& simulation) {
  const StandingFrame& frame = simulation.frame();
  const Building& building = simulation.building();
  for (std::size_t n = 0; n < building.nodes.size(); ++n)
    if (frame.stands(NodeId(n))) seen.line(frame.displacement(NodeId(n)), frame.reaction(NodeId(n)));
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    seen.line(simulation.body_of(MemberId(m)), frame.segment(MemberId(m)), frame.end_forces(MemberId(m)));
    if (m % 37 == 0)
      for (const Carrier& carrier : simulation.what_carries(MemberId(m))) seen.line(carrier.joint, carrier.share);
  }
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const auto broken = simulation.broken_panel(PanelId(p));
    seen.line(simulation.body_of(PanelId(p)), broken != nullptr);
    if (broken) seen.line(broken->positions, broken->normals);
  }
  for (std::size_t j = 0; j < building.joints.size(); ++j) {
    const JointId joint(j);
    seen.line(frame.intact(joint), frame.demand(joint), frame.utilisation(joint),
              frame.largest_utilisation_so_far(joint), building[joint].capacity.value);
  }
  seen.line(simulation.next_to_break(5));
}

void see_bodies(Seen& seen, const Simulation& simulation) {
  for (const BodyView& body : simulation.bodies()) {
    seen.line(body.id, body.name, body.pose.position, body.pose.orientation.coeffs(), body.rest_centre, body.mass,
              body.radius, body.asleep, body.members, body.panels, static_cast<int>(body.chunk_of));
    if (body.chunk) seen.line(body.chunk->positions, body.chunk->normals);
    if (body.cable_anchor) seen.line(*body.cable_anchor);
  }
  seen.line(simulation.poses());
  const PieceChanges& changes = simulation.changes();
  seen.line(changes.made, changes.gone, changes.moved);
  for (const auto& [from, to] : changes.split) seen.line(from, to);
  for (const HostImpulse& felt : simulation.host_impulses())
    seen.line(felt.key, felt.impulse, felt.speed_in, felt.speed_out, felt.through);
  for (int i = 0; i < 40; ++i) {
    const Vec3 from(-30, 0.7 * i - 5, 0.4 * i), to(5, 10, 3);
    const auto hit = simulation.ray_cast(from, to - from);
    if (hit) seen.line(hit->member, hit->panel, hit->body, hit->point, hit->distance);
  }
}

/// Hashes by the number of the step. `before_step` is called before each.
std::map<std::int64_t, std::uint64_t> run_through(Simulation& simulation, const std::function<void()>& before_step) {
  std::map<std::int64_t, std::uint64_t> hashes;
  while (!simulation.finished()) {
    if (before_step) before_step();
    simulation.step();
    hashes[simulation.steps()] = simulation.hash();
  }
  return hashes;
}

}  // namespace

std::string seen_of(const Simulation& simulation) {
  Seen seen;
  seen.line(simulation.steps(), simulation.time(), simulation.hash());
  see_accounts(seen, simulation);
  see_what_stands(seen, simulation);
  see_bodies(seen, simulation);
  return seen.text();
}

void goes_on_alike(const SavedRun& run) {
  const auto act = [&](Simulation& simulation) {
    if (run.host) run.host(simulation);
  };
  Simulation through = run.make();
  const auto expected = run_through(through, [&] { act(through); });
  const std::string end = seen_of(through);

  struct Saved {
    double moment = 0;
    std::string state, seen;
  };
  std::vector<Saved> all;
  Simulation saved = run.make();
  const auto while_saved = run_through(saved, [&] {
    act(saved);
    while (all.size() < run.moments.size() && saved.time() >= run.moments[all.size()]) {
      const std::string state = state_of(saved);
      CHECK((state_of(saved) == state));
      all.push_back({run.moments[all.size()], state, seen_of(saved)});
    }
  });
  CHECK(while_saved == expected);
  CHECK((seen_of(saved) == end));
  REQUIRE(all.size() == run.moments.size());

  for (const Saved& one : all) {
    CAPTURE(one.moment, one.state.size());
    Simulation loaded = run.make();
    load(loaded, one.state);
    CHECK((state_of(loaded) == one.state));
    CHECK((seen_of(loaded) == one.seen));
    bool acted = true;  // the host had acted when the state was saved
    const auto hashes = run_through(loaded, [&] {
      if (run.host && !std::exchange(acted, false)) run.host(loaded);
      if (!run.host) loaded.skip_idle();
    });
    const auto other = std::find_if(hashes.begin(), hashes.end(), [&](const auto& step) {
      const auto then = expected.find(step.first);
      return then == expected.end() || then->second != step.second;
    });
    if (other != hashes.end()) FAIL_CHECK("step " << other->first << " is another");
    CHECK((seen_of(loaded) == end));
  }
}

}  // namespace topple::test
