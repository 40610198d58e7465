// Mechanisms that hang on hinges, against the rod that swings down from the horizontal: w^2 = 3 g sin(a)/L, and a pull
// along it of 2.5 W sin(a) when it has come down by the angle a.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "support/scratch_folder.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;

namespace {

constexpr double length = 4, area = 0.2 * 0.2 - 0.18 * 0.18, weight = 7850 * area * length * 9.80665;

/// A beam pinned to a mast (free about the horizontal axis across it) and propped at its other end.
std::string model(double tension) {
  return R"({"topple": 1, "title": "Beam on a pin",
 "materials": {"S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
 "sections": {"tube": {"shape": "box", "depth": 0.2, "width": 0.2, "thickness": 0.01}},
 "joints": {"pin": {"stiffness": {"ry": 0}, "capacity": {"tension": )" +
         std::to_string(tension) + R"(, "compression": 1e7, "shear_y": 1e7, "shear_z": 1e7, "torsion": 1e7,
                    "moment_y": 1e7, "moment_z": 1e7}}},
 "nodes": {"F": [0, 0, 0], "H": [0, 0, 10], "G": [4, 0, 0], "T": [4, 0, 10]},
 "members": {"PM": {"kind": "post", "nodes": ["F", "H"], "section": "tube", "material": "S355"},
             "B": {"nodes": ["H", "T"], "section": "tube", "material": "S355", "joints": ["pin", null]},
             "PP": {"kind": "post", "nodes": ["G", "T"], "section": "tube", "material": "S355"}},
 "supports": {"F": "fixed", "G": "fixed"}})";
}

Simulation swinging(double tension, const std::string& rule, double step = 1.0 / 240,
                    const std::string& standing = "static") {
  const topple::test::ScratchFolder folder;
  std::FILE* file = std::fopen((folder / "pin.json").string().c_str(), "w");
  REQUIRE(file != nullptr);
  std::fputs(model(tension).c_str(), file);
  std::fclose(file);
  auto [building, scenario] = parse_scenario(R"({"topple": 1, "model": "pin.json", "standing": ")" + standing +
                                                 R"(", "duration": 8, "step": )" + std::to_string(step) +
                                                 R"(, "failure": {"bracing": "none", "mechanism": ")" + rule + R"("},
                         "events": [{"at": 0.5, "remove": {"members": ["PP"]}}]})",
                                             "s.json", folder.path());
  if (scenario.standing == StandingRule::dynamics) scenario.motion.damping = 0;
  return Simulation(std::move(building), std::move(scenario));
}

/// How far the rod has come down from the horizontal.
double angle(const BodyView& body) {
  const Vec3 along = body.pose.orientation * Vec3::UnitX();
  return std::atan2(-along.z(), along.x());
}

std::vector<SimulationEvent> broken(const Simulation& simulation) {
  std::vector<SimulationEvent> found;
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == SimulationEvent::Kind::joint_broke) found.push_back(event);
  return found;
}

}  // namespace

TEST_CASE("a beam that lost its prop swings on its pin as a rod does, and its pull loads what it hangs on") {
  Simulation simulation = swinging(1e7, "hinge");
  double fastest = 0, heaviest = 0, last = 0, highest = 0;
  while (!simulation.finished()) {
    simulation.step();
    for (const BodyView& body : simulation.bodies()) {
      CHECK((body.pose * Vec3(-length / 2, 0, 0) - Vec3(0, 0, 10)).norm() < 0.02);  // it hangs where it hung
      const double now = angle(body);
      if (last != 0) fastest = std::max(fastest, std::abs(now - last) * 240);
      highest = std::max(highest, now);
      last = now;
    }
    const NodeId foot = *NameIndex(simulation.building()).node("F");
    heaviest = std::max(heaviest, simulation.frame().reaction(foot)(2));
  }
  REQUIRE(simulation.bodies().size() == 1);
  CHECK(broken(simulation).empty());
  // First order in the step: the solver loses a share (w dt)^2 of the energy in each step of the swing.
  CHECK(fastest == Approx(std::sqrt(3 * 9.80665 / length)).epsilon(0.02));
  CHECK(highest > 0.9 * M_PI);  // nearly as far up on the other side
  const double mast = weight / length * 10;
  // The peak of 2.5 W is smoothed over a tenth of a second; without the beam there is the mast alone.
  CHECK(heaviest > mast + 1.8 * weight);
  CHECK(heaviest < mast + 2.6 * weight);
  CHECK(std::abs(simulation.ledger().residual()) < 0.01);
}

TEST_CASE("a pin breaks at the angle at which the swinging beam pulls with its capacity") {
  Simulation simulation = swinging(2 * weight, "hinge");
  double last = 0, at_break = 0;
  while (!simulation.finished() && broken(simulation).empty()) {
    for (const BodyView& body : simulation.bodies()) last = angle(body);
    simulation.step();
    if (!broken(simulation).empty()) at_break = (last + angle(simulation.bodies()[0])) / 2;
  }
  REQUIRE(broken(simulation).size() == 1);
  const SimulationEvent event = broken(simulation)[0];
  CHECK(event.name == "B:1");
  CHECK(event.joint.sense == Sense::tension);
  CHECK(event.joint.capacity == Approx(2 * weight).epsilon(1e-5));
  // One step is 0.011 rad at that speed; the pull is a mean over it.
  CHECK(at_break == Approx(std::asin(2 / 2.5)).margin(0.03));
  while (!simulation.finished()) simulation.step();
  CHECK(simulation.bodies()[0].pose.position.z() < 1);  // it has fallen
}

TEST_CASE("by the rule detach the same beam lets go at once") {
  Simulation simulation = swinging(1e7, "detach");
  while (!simulation.finished()) simulation.step();
  REQUIRE(broken(simulation).size() == 1);
  CHECK(simulation.bodies()[0].pose.position.z() < 1);
}

namespace {

/// The mast as one cantilever with consistent mass (displacement and turn of its head), and the rod that hangs at the
/// head: from the horizontal it has come down by `angle`. The head goes along x alone.
struct MastAndRod {
  Eigen::Vector2d u, v;
  double angle = 0, spin = 0;

  struct Change {
    Eigen::Vector2d u, v;
    double angle, spin;
  };
  [[nodiscard]] Change change() const {
    constexpr double tall = 10, E = 210e9, I = (0.2 * 0.2 * 0.2 * 0.2 - 0.18 * 0.18 * 0.18 * 0.18) / 12, g = 9.80665,
                     rod = weight / g, mast = 7850 * area * tall, half = length / 2;
    Eigen::Matrix2d M, K;
    M << 156, -22 * tall, -22 * tall, 4 * tall * tall;
    K << 12, -6 * tall, -6 * tall, 4 * tall * tall;
    M *= mast / 420;
    K *= E * I / (tall * tall * tall);
    // Accelerations of the head, its turn and the rod.
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b;
    A.topLeftCorner<2, 2>() = M;
    A(0, 0) += rod;
    A(0, 2) = A(2, 0) = -rod * half * std::sin(angle);
    A(2, 2) = rod * length * length / 3;
    b.head<2>() = -K * u;
    b(0) += rod * half * std::cos(angle) * spin * spin;
    b(2) = rod * g * half * std::cos(angle);
    const Eigen::Vector3d a = A.ldlt().solve(b);
    return {v, a.head<2>(), spin, a(2)};
  }
  [[nodiscard]] MastAndRod moved(const Change& by, double h) const {
    return {u + h * by.u, v + h * by.v, angle + h * by.angle, spin + h * by.spin};
  }
  /// Runge-Kutta of fourth order.
  void advance(double h) {
    const Change a = change(), b = moved(a, h / 2).change(), c = moved(b, h / 2).change(), d = moved(c, h).change();
    *this = {u + h / 6 * (a.u + 2 * b.u + 2 * c.u + d.u), v + h / 6 * (a.v + 2 * b.v + 2 * c.v + d.v),
             angle + h / 6 * (a.angle + 2 * b.angle + 2 * c.angle + d.angle),
             spin + h / 6 * (a.spin + 2 * b.spin + 2 * c.spin + d.spin)};
  }
};

}  // namespace

TEST_CASE("a beam that hangs on a mast that sways rides with its head, and the mast sways with the beam's mass") {
  Simulation simulation = swinging(1e7, "hinge", 1.0 / 240, "dynamic");
  const NameIndex names(simulation.building());
  const NodeId head = *names.node("H"), foot = *names.node("F");
  while (!simulation.finished() && simulation.bodies().empty()) simulation.step();
  REQUIRE(simulation.bodies().size() == 1);
  const auto displaced = [&] { return simulation.frame().displacement(head); };
  const double before = angle(simulation.bodies()[0]);
  simulation.step();
  const Vec6 at = displaced(), speed = simulation.frame().velocity(head);
  MastAndRod wanted{{at(0), at(4)}, {speed(0), speed(4)}, angle(simulation.bodies()[0])};
  simulation.step();
  wanted.spin = (angle(simulation.bodies()[0]) - before) * 240 / 2;
  for (int k = 0; k < 10; ++k) wanted.advance(1.0 / 2400);
  // Off by what the part's mean displacement had it off when it left.
  const auto hangs_at = [&] {
    return Vec3(simulation.bodies()[0].pose * Vec3(-length / 2, 0, 0) - displaced().head<3>());
  };
  const Vec3 hung_at = hangs_at();
  double farthest = 0, off = 0, turned_off = 0, apart = 0, down = 0;
  int steps = 0;
  for (; steps < 2 * 240; ++steps) {
    simulation.step();
    for (int k = 0; k < 10; ++k) wanted.advance(1.0 / 2400);
    const BodyView& body = simulation.bodies()[0];
    apart = std::max(apart, (hangs_at() - hung_at).norm());
    farthest = std::max(farthest, std::abs(wanted.u(0)));
    off = std::max(off, std::abs(displaced()(0) - wanted.u(0)));
    turned_off = std::max(turned_off, std::abs(std::remainder(angle(body) - wanted.angle, 2 * M_PI)));
    down += simulation.frame().reaction(foot)(2);
  }
  INFO("sways by " << farthest << " m, off by " << off << " m and " << turned_off << " rad, apart by " << apart
                   << ", residual " << simulation.ledger().residual() << ", foot bears " << down / steps);
  CHECK(farthest > 0.05);
  CHECK(apart < 0.002);
  CHECK(off < 0.03 * farthest);
  CHECK(turned_off < 0.01);
  CHECK(std::abs(simulation.ledger().residual()) < 0.01);
  CHECK(broken(simulation).empty());
}
