// Shell panels in motion: their mass against rigid bodies, their swing against a global mesh, losses and balls.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "standing/panel_superelement.h"
#include "structure/frame_builder.h"
#include "structure/simulation_run.h"
#include "structure/unbraced_rules.h"
#include "topple/solver/modes.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/frame.h"
#include "topple/structure/simulation.h"
#include "topple/structure/standing_frame.h"

using namespace topple::test;

namespace {

constexpr double step = 1.0 / 60;

/// A slab of 6 m by 4 m on four posts of 3 m, its corners fixed to their tops; `opening`: in the slab.
std::string table(const std::string& opening = {}) {
  return R"({"topple": 1, "title": "Table",
 "materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 2400, "compressive_strength": 30e6,
                     "tensile_strength": 2.9e6}},
 "sections": {"post": {"shape": "rectangle", "width": 0.25, "depth": 0.25}},
 "nodes": {"A0": [0, 0, 0], "B0": [6, 0, 0], "C0": [6, 4, 0], "D0": [0, 4, 0],
           "A1": [0, 0, 3], "B1": [6, 0, 3], "C1": [6, 4, 3], "D1": [0, 4, 3]},
 "members": {"PA": {"kind": "post", "nodes": ["A0", "A1"], "section": "post", "material": "c"},
             "PB": {"kind": "post", "nodes": ["B0", "B1"], "section": "post", "material": "c"},
             "PC": {"kind": "post", "nodes": ["C0", "C1"], "section": "post", "material": "c"},
             "PD": {"kind": "post", "nodes": ["D0", "D1"], "section": "post", "material": "c"}},
 "panels": {"S": {"kind": "slab", "nodes": ["A1", "B1", "C1", "D1"], "thickness": 0.3, "material": "c",
                  "model": "shell", "mesh": [12, 8])" +
         opening + R"(}},
 "supports": {"A0": "fixed", "B0": "fixed", "C0": "fixed", "D0": "fixed"},
 "loads": {"dead": {"self_weight": 1.0}}})";
}

Building parsed(const std::string& text) { return parse_model(text, "table.json", Purpose::demolish); }

/// rad/s, of the whole mesh with its mass where it is: nothing is condensed.
double lowest_of_mesh(const Building& building) {
  topple::solver::FrameModel model = make_frame(building).model;
  for (topple::solver::Beam& beam : model.beams) beam.density = building.materials[0].density;
  for (topple::solver::Shell& shell : model.shells) shell.density = building.materials[0].density;
  return topple::solver::natural_modes(model, {}, 1, {}).modes.front().angular_frequency;
}

/// rad/s, by the first peak of the slab's corners, of the same sudden load on all of them along `direction`.
double swing(const Building& building, int direction) {
  StandingFrame frame(building, CombinationId(0u), unbraced_rules());
  frame.let_move(1.0 / 2000);
  const NodeId seen(4u);
  const double before = frame.displacement(seen)(direction);
  Vec6 load = Vec6::Zero();
  load(direction) = 1e4;
  for (std::size_t n = 4; n < 8; ++n) frame.add_load(NodeId(n), load);
  double last = 0, now = 0, last_but_one = 0;
  int steps = 0;
  do {
    (void)frame.move();
    ++steps;
    last_but_one = last;
    last = now;
    now = std::abs(frame.displacement(seen)(direction) - before);
  } while (now >= last && steps < 4000);
  // Where the parabola through the three has its top.
  const double ahead = 0.5 * (now - last_but_one) / (2 * last - now - last_but_one);
  return std::numbers::pi * 2000 / (steps - 1 + ahead);
}

}  // namespace

TEST_CASE("A shell's mass moves as a rigid plate does: its weight, its first and its second moments") {
  for (const std::string opening : {"", R"(, "openings": [[[1, 1], [3, 1], [3, 2.5], [1, 2.5]]])"}) {
    const Building b = parsed(table(opening));
    const Frame frame = make_frame(b);
    const PanelSuperelement slab(b, frame, PanelId(0u));
    const double kilograms = 9000;
    const Eigen::MatrixXd M = slab.mass(kilograms);
    const auto motion = [&](int component) {
      Eigen::VectorXd u(24);
      for (std::size_t n = 0; n < 4; ++n) {
        Vec6 at = Vec6::Zero();
        at(component) = 1;
        if (component > 2) at.head<3>() = Vec3::Unit(component - 3).cross(b[b.panels[0].nodes[n]].position);
        u.segment<6>(static_cast<Eigen::Index>(6 * n)) = at;
      }
      return u;
    };
    // Moments of the whole less those of the opening, per kilogram and square metre.
    const double area = opening.empty() ? 24 : 21, density = kilograms / area;
    const double x = density * (6 * 4 * 3.0 - (opening.empty() ? 0 : 2 * 1.5 * 2.0)),
                 yy = density * (6 * 64 / 3.0 - (opening.empty() ? 0 : 2 * (std::pow(2.5, 3) - 1) / 3)),
                 xx = density * (4 * 216 / 3.0 - (opening.empty() ? 0 : 1.5 * (27 - 1) / 3.0));
    for (int c = 0; c < 3; ++c) CHECK(motion(c).dot(M * motion(c)) == Approx(kilograms).epsilon(1e-9));
    CHECK(motion(2).dot(M * motion(4)) == Approx(-x).epsilon(1e-9));  // -x about y moves down
    const double thickness = kilograms * 0.3 * 0.3 / 12;              // of 0.3 m, about its mean plane
    CHECK(motion(3).dot(M * motion(3)) ==
          Approx(yy + 9 * kilograms + thickness).epsilon(1e-9));  // 3 m above the origin
    CHECK(motion(5).dot(M * motion(5)) == Approx(xx + yy).epsilon(1e-9));
    CHECK((M - M.transpose()).norm() == 0);
    // Nothing is without inertia: the least is some of the thickness's.
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues()(0) > 1e-3 * thickness);
  }
}

TEST_CASE("What is left of a shell keeps the momentum of its motion, and of a rigid motion all of it") {
  const Building b = parsed(table());
  const Frame frame = make_frame(b);
  PanelSuperelement slab(b, frame, PanelId(0u));
  const double kilograms = 9000;
  std::vector<std::vector<Vec6>> motions;  // six rigid ones, then one that bends and one that drills
  for (int c = 0; c < 6; ++c) {
    std::vector<Vec6> own(4, Vec6::Unit(c));
    if (c > 2)
      for (std::size_t n = 0; n < 4; ++n) own[n].head<3>() = Vec3::Unit(c - 3).cross(b[b.panels[0].nodes[n]].position);
    motions.push_back(own);
  }
  for (const int c : {4, 5}) {
    motions.emplace_back(4, Vec6::Zero());
    motions.back()[2](c) = 1;
  }
  const auto column = [](const std::vector<Vec6>& at_nodes) {
    Eigen::VectorXd v(24);
    for (std::size_t n = 0; n < 4; ++n) v.segment<6>(static_cast<Eigen::Index>(6 * n)) = at_nodes[n];
    return v;
  };
  std::vector<Eigen::VectorXd> before;
  for (const auto& own : motions) {
    before.push_back(slab.motion(own));
    const Eigen::VectorXd whole = slab.mass(kilograms) * column(own);
    CHECK((slab.momentum(kilograms, before.back()) - whole).norm() < 1e-9 * whole.norm());
  }
  PanelRemains remains;  // a hole of 2 m by 1.5 m at a corner, which is left hanging
  remains.holes = {{Vec2(4, 0.5), Vec2(6, 0.5), Vec2(6, 2), Vec2(4, 2)}};
  remains.share = 21.0 / 24;
  remains.edge_length = {6, 2.5, 6, 4};
  slab.fracture(remains);
  const Eigen::MatrixXd M = slab.mass(kilograms * remains.share);
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const Eigen::VectorXd momentum = slab.momentum(kilograms * remains.share, before[m]);
    const Eigen::VectorXd now = M.ldlt().solve(momentum), own = column(motions[m]);
    // Whatever it was: linear and angular momentum are those of the material that is left.
    for (std::size_t r = 0; r < 6; ++r) {
      const Eigen::VectorXd rigid = column(motions[r]);
      CHECK(rigid.dot(M * now) == Approx(rigid.dot(momentum)).margin(1e-9 * kilograms));
    }
    if (m < 6) CHECK((M * own - momentum).norm() < 1e-9 * momentum.norm());
    // As the nodes go on, without regard to the hole: never less energy than the nearest motion has, and more by what
    // the two differ in.
    CHECK(now.dot(momentum) / 2 >= own.dot(momentum) - own.dot(M * own) / 2 - 1e-9 * momentum.norm());
  }
}

TEST_CASE("A slab on posts sways as the whole mesh does") {
  const Building b = parsed(table());
  // 5 % of damping make the period 0.1 % longer; what higher modes add to the peak's time is as little.
  CHECK(std::min(swing(b, 0), swing(b, 1)) == Approx(lowest_of_mesh(b)).epsilon(0.01));
}

TEST_CASE("What a shell on posts has lost sways to the static state of what is left, and energy and momentum close") {
  const Building b = parsed(table());
  StandingFrame moving(b, CombinationId(0u), unbraced_rules()), still(b, CombinationId(0u), unbraced_rules());
  moving.let_move(step);
  Vec6 load = Vec6::Zero();
  load << 3e4, 1e4, -5e4, 0, 0, 0;
  for (StandingFrame* frame : {&moving, &still}) {
    frame->add_load(NodeId(6u), load);
    frame->remove(MemberId(1u));
  }
  (void)still.settle(1000);
  double peak = 0, worst = 0;
  for (int n = 0; n < 3600 && moving.pending(); ++n) {
    CHECK(moving.move().empty());
    const FrameEnergy e = moving.energy();
    peak = std::max(peak, -moving.displacement(NodeId(5u)).z());
    worst = std::max(worst, std::abs(e.elastic - e.elastic_at_start + e.kinetic + e.damped + e.numerical + e.freed -
                                     e.gravity_work - e.other_work - e.contact_work - e.struck));
  }
  CHECK_FALSE(moving.pending());
  for (std::size_t n = 4; n < 8; ++n)
    CHECK((moving.displacement(NodeId(n)) - still.displacement(NodeId(n))).norm() <
          1e-9 * still.displacement(NodeId(n)).norm());
  CHECK(peak > 1.3 * -still.displacement(NodeId(5u)).z());  // it went on beyond
  // The strain between the lost post's ends, of its own weight (q2 L3/(24 EA), 1.3 mJ), left with it: no motion has it.
  CHECK(worst < 1e-5 * moving.energy().damped);
}

TEST_CASE("A shell that breaks while it moves gains no energy, however its nodes turn") {
  const Building b = parsed(table());
  StandingFrame frame(b, CombinationId(0u), unbraced_rules());
  frame.let_move(step);
  const ContactPlace place{{}, PanelId(0u), Vec3(5, 1, 3)};
  const Vec3 down(0, 0, -1);
  const auto pushed = frame.respond_held({&place, 1}, {&down, 1});
  (void)frame.strike(pushed, Eigen::VectorXd::Constant(1, 5e4));
  const FrameEnergy before = frame.energy();
  // Away from three of its posts: as its fourth turns, so would all of it.
  PanelRemains remains;
  remains.holes = {{Vec2(5, 0), Vec2(6, 0), Vec2(6, 1), Vec2(5, 1)},
                   {Vec2(5, 3), Vec2(6, 3), Vec2(6, 4), Vec2(5, 4)},
                   {Vec2(0, 3), Vec2(1, 3), Vec2(1, 4), Vec2(0, 4)}};
  remains.share = 21.0 / 24;
  remains.edge_length = {5, 2, 4, 3};
  frame.fracture(PanelId(0u), remains);
  double worst = 0;
  for (int n = 0; n < 30; ++n) {
    (void)frame.move();
    const FrameEnergy e = frame.energy();
    worst = std::max(worst, std::abs(e.elastic - e.elastic_at_start + e.kinetic + e.damped + e.numerical + e.freed -
                                     e.gravity_work - e.other_work - e.contact_work - e.struck));
    CHECK(e.kinetic < before.kinetic);
  }
  CHECK(frame.energy().freed > 0);  // with what broke out, and in what is left as it took over its motion
  CHECK(worst < 1e-9 * before.kinetic);
}

namespace {

/// A slab of 6 m by 4 m that lies on four beams between massless posts, all of the mass its own.
Building lying_slab() {
  FrameBuilder frame;
  std::array<NodeId, 4> top;
  const std::array<Vec3, 4> at{Vec3(0, 0, 3), Vec3(6, 0, 3), Vec3(6, 4, 3), Vec3(0, 4, 3)};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string name(1, static_cast<char>('A' + i));
    const NodeId foot = frame.node(name + "0", at[i].x(), at[i].y(), 0);
    top[i] = frame.node(name + "1", at[i].x(), at[i].y(), at[i].z());
    frame.member("P" + name, MemberKind::post, foot, top[i]);
    frame.support(foot);
  }
  for (std::size_t i = 0; i < 4; ++i) frame.member("B" + std::to_string(i), MemberKind::beam, top[i], top[(i + 1) % 4]);
  frame.building.materials.push_back(frame.building.materials[0]);
  frame.building.materials[1].density = 2400;
  const PanelId slab = frame.panel("S", PanelModel::membrane, top);
  frame.building.panels[static_cast<std::size_t>(slab.index)].material = MaterialId(1u);
  frame.load_case().self_weight = Vec3(0, 0, -1);
  return frame.building;
}

/// As the slab turns about all axes a corner of it breaks out and leaves with the velocity of its place, or (`told`
/// false) the frame is not told with which. What is left over of the momentum, as a share of that at first.
Vec3 left_over(const Building& b, const Vec3& middle, bool told) {
  const PanelId slab(0u);
  StandingFrame frame(b, CombinationId(0u), unbraced_rules());
  MotionRules undamped;  // damping of the stiffness hands impulses to the ground
  undamped.damping = 0;
  frame.let_move(step, undamped);
  StandingFrame::HeldResponse pushed;
  for (const auto& [point, direction] :
       {std::pair(Vec3(5, 1, 3), Vec3(0, 0, -1)), std::pair(Vec3(3, 0.5, 3), Vec3(1, 0, 0))}) {
    const ContactPlace place{{}, slab, point};
    pushed = frame.respond_held({&place, 1}, {&direction, 1});
    (void)frame.strike(pushed, Eigen::VectorXd::Constant(1, 5e4));
  }
  const auto motion = frame.motion(slab);
  CHECK(motion.spin.cwiseAbs().minCoeff() > 1e-3 * motion.spin.norm());
  const double mass = frame.mass(slab);
  const Vec3 had = mass * motion.velocity;
  PanelRemains remains;
  remains.holes = {{Vec2(4, 0.5), Vec2(6, 0.5), Vec2(6, 2), Vec2(4, 2)}};
  remains.share = 21.0 / 24;
  remains.edge_length = {6, 2.5, 6, 4};
  const Vec3 centre = b[b.panels[0].nodes[0]].position + Vec3(5, 1.25, 0),
             taken = mass * (1 - remains.share) * (motion.velocity + motion.spin.cross(centre - middle));
  frame.fracture(slab, remains, told ? std::optional(taken) : std::nullopt);
  (void)frame.begin_move();
  (void)frame.strike(pushed, Eigen::VectorXd::Zero(1));  // so that all acts now
  CHECK(frame.mass(slab) == Approx(mass * remains.share).epsilon(1e-12));
  return (had - taken - frame.mass(slab) * frame.motion(slab).velocity) / had.norm();
}

}  // namespace

TEST_CASE("A chunk leaves a slab that turns with the velocity of its place, and linear momentum is kept") {
  std::string light = table();  // posts without mass
  const std::string material = R"("c": {)", posts = R"("section": "post", "material": "c")";
  for (std::size_t at = 0; (at = light.find(posts, at)) != std::string::npos;)
    light.replace(at, posts.size(), R"("section": "post", "material": "light")");
  light.replace(light.find(material), material.size(),
                R"("light": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 1e-9}, "c": {)");
  for (const Building& b : {parsed(light), lying_slab()}) {
    INFO(b.title);
    CHECK(left_over(b, Vec3(3, 2, 3), true).norm() < 1e-10);
    CHECK(left_over(b, Vec3(3, 2, 3), false).norm() > 1e-3);
  }
}

TEST_CASE("A ball goes through a shell wall that moves, chunks fly, and the wall comes to rest") {
  auto [model, scenario] = read_scenario(find_scenario("wall_hit"));
  scenario.standing = StandingRule::dynamics;
  Simulation simulation(model, scenario);
  const double whole = simulation.frame().mass(PanelId(0u));
  run(simulation);
  REQUIRE_FALSE(of_kind(simulation, SimulationEvent::Kind::panel_fractured).empty());
  double chunks = 0;
  for (const BodyView& body : simulation.bodies()) chunks += body.chunk ? body.mass : 0;
  CHECK(chunks > 0);
  CHECK(chunks + simulation.frame().mass(PanelId(0u)) == Approx(whole).epsilon(2e-3));  // but for dust
  CHECK(simulation.at_rest());
  CHECK(simulation.frame().stands(PanelId(0u)));
  CHECK(simulation.ledger().momentum_error < 1e-10);
  CHECK(std::abs(simulation.ledger().residual()) < 0.005);
}
