// A row of masses on hangers that fail one after the other, against an integration of the same row that shares no code:
// Runge and Kutta's fourth order with steps far shorter than a substep, its damping from its own modes.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "structure/frame_builder.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;

constexpr int count = 20;
constexpr double mass = 400, weight = 10 * mass, hanger = 1.5e6, link = 0.5e6, capacity = 7000, apart = 6, drop = 2;
constexpr double step = 1.0 / 60, substep = step / 8;

/// Masses that move along z alone, each on a hanger; neighbours shear the link between them.
FrameBuilder row_frame() {
  FrameBuilder frame;
  const double E = frame.building.materials[0].youngs_modulus;
  Section bar = frame.building.sections[0];
  bar.name = "hanger";
  bar.area = hanger * drop / E;
  bar.Iy = bar.Iz = bar.J = 1e-9;
  Section beam = bar;
  beam.name = "link";
  beam.area = 0.01;
  beam.Iy = beam.Iz = beam.J = link * std::pow(apart, 3) / (12 * E);
  frame.building.sections = {bar, beam};
  std::vector<NodeId> low, high;
  for (int i = 0; i < count; ++i) low.push_back(frame.node("L" + std::to_string(i), i * apart, 0, 3));
  for (int i = 0; i < count; ++i) high.push_back(frame.node("H" + std::to_string(i), i * apart, 0, 3 + drop));
  for (int i = 0; i < count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    frame.member("hanger" + std::to_string(i), MemberKind::post, low[n], high[n], same_capacity(unlimited),
                 same_capacity(capacity));
    frame.support(high[n]);
    Vec6 held = Vec6::Constant(unlimited);
    held(2) = 0;
    frame.building.supports.push_back({low[n], held});
    Vec6 load = Vec6::Zero();
    load.z() = -weight;
    frame.load(low[n], load);
  }
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const MemberId own = frame.member("link" + std::to_string(i), MemberKind::beam, low[i], low[i + 1]);
    frame.building.members[static_cast<std::size_t>(own.index)].section = SectionId(1u);
  }
  return frame;
}

using Row = Eigen::Matrix<double, count, 1>;
using Matrix = Eigen::Matrix<double, count, count>;

Matrix stiffness(const std::array<bool, count>& holds) {
  Matrix K = Matrix::Zero();
  for (int i = 0; i < count; ++i) {
    if (holds[static_cast<std::size_t>(i)]) K(i, i) += hanger;
    if (i + 1 == count) continue;
    K(i, i) += link;
    K(i + 1, i + 1) += link;
    K(i, i + 1) -= link;
    K(i + 1, i) -= link;
  }
  return K;
}

/// Times at which hangers fail after the first is lost at 0; infinite: never.
std::array<double, count> by_integration(double until) {
  std::array<bool, count> holds{};
  holds.fill(true);
  const Matrix whole = stiffness(holds);
  const double w1 = std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix>(whole).eigenvalues()(0) / mass);
  const Row f = Row::Constant(weight);
  Row u = whole.ldlt().solve(f), v = Row::Zero();
  const double w2 = std::sqrt(f.dot(u) / (mass * u.squaredNorm()));
  const double a0 = 2 * 0.02 * w1 * w2 / (w1 + w2), a1 = 2 * 0.02 / (w1 + w2);
  std::array<double, count> times;
  times.fill(std::numeric_limits<double>::infinity());
  holds[0] = false;
  times[0] = 0;
  Matrix K = stiffness(holds);
  const double h = 2e-5;
  const auto acceleration = [&](const Row& x, const Row& y) -> Row { return (f - K * (x + a1 * y)) / mass - a0 * y; };
  for (double t = 0; t < until; t += h) {
    const Row a_1 = acceleration(u, v), a_2 = acceleration(u + h / 2 * v, v + h / 2 * a_1);
    const Row a_3 = acceleration(u + h / 2 * (v + h / 2 * a_1), v + h / 2 * a_2);
    const Row a_4 = acceleration(u + h * (v + h / 2 * a_2), v + h * a_3);
    u += h * (v + h / 6 * (a_1 + a_2 + a_3));
    v += h / 6 * (a_1 + 2 * a_2 + 2 * a_3 + a_4);
    for (int i = 0; i < count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      if (!holds[n] || !(hanger * u(i) > capacity)) continue;
      holds[n] = false;
      times[n] = t + h;
      K = stiffness(holds);
    }
  }
  return times;
}

}  // namespace

TEST_CASE(
    "Hangers of a standing row fail one after the other, in the order and within a substep of the time that an "
    "independent integration has") {
  constexpr double until = 1;
  const std::array<double, count> expected = by_integration(until);
  REQUIRE(std::count_if(expected.begin(), expected.end(), [](double t) { return std::isfinite(t); }) == count);
  const FrameBuilder frame = row_frame();
  FailureRules rules;
  rules.bracing = BracingRule::none;
  rules.sudden = 1;
  StandingFrame standing(frame.building, CombinationId(0u), rules);
  standing.let_move(step);
  standing.break_joint(frame.building.joint(MemberId(0u), 1), BreakCause::tool);
  std::vector<int> order;
  double worst = 0;
  for (int n = 0; n * step < until; ++n)
    for (const JointBreak& one : standing.move()) {
      const int which = frame.building[one.joint].member.index;
      if (which != 0) {
        // Known to a substep alone: of its middle.
        const double time = n * step + (one.generation + 0.5) * substep;
        worst = std::max(worst, std::abs(time - expected[static_cast<std::size_t>(which)]) / substep);
      }
      order.push_back(which);
    }
  REQUIRE(order.size() == count);
  for (std::size_t i = 0; i + 1 < order.size(); ++i)
    CHECK(expected[static_cast<std::size_t>(order[i])] < expected[static_cast<std::size_t>(order[i + 1])]);
  INFO("worst " << worst << " substeps off");
  CHECK(worst < 1.5);  // half a substep of reading, and one
}
