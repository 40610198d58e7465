// Several contacts of one body: against closed forms and an integration in small steps that shares no code.
#include <catch2/catch.hpp>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "simulation/impact/coupled_push.h"
#include "simulation/impact/indentation.h"

namespace {

using namespace topple::structure;

constexpr double m = 300, k = 2e6, v = 4;

PushingBody falling(const Mat3& inertia, double speed = v, double weight = 0) {
  PushingBody body;
  body.mass = m;
  body.inertia = inertia;
  body.velocity = Vec3(0, 0, -speed);
  body.weight = Vec3(0, 0, -weight);
  return body;
}
PushedPlace below(double x, double y) { return {Vec3(x, y, -0.1), -Vec3::UnitZ()}; }

Mat3 bar(double length) {
  const double about = m * length * length / 12;
  return Vec3(1e-3 * about, about, about).asDiagonal();
}

Eigen::MatrixXd springs(std::initializer_list<double> stiffness) {
  Eigen::VectorXd c(static_cast<Eigen::Index>(stiffness.size()));
  Eigen::Index i = 0;
  for (const double each : stiffness) c(i++) = 1 / each;
  return c.asDiagonal();
}

}  // namespace

TEST_CASE("four equal corners on springs feel v sqrt(k m)/2 each, and the body leaves as fast as it came") {
  CoupledPush push(falling(m * Mat3::Identity()), {below(1, 1), below(-1, 1), below(-1, -1), below(1, -1)},
                   springs({k, k, k, k}));
  CHECK(push.push() == CoupledPush::Stop::left);
  for (int i = 0; i < 4; ++i) CHECK(push.peak_force()(i) == Approx(v * std::sqrt(k * m) / 2).epsilon(1e-9));
  CHECK(push.velocity().z() == Approx(v).epsilon(1e-9));
  CHECK(push.spin().norm() < 1e-9);
  // Half a period of m on 4 k.
  CHECK(push.time() == Approx(M_PI * std::sqrt(m / (4 * k))).epsilon(1e-9));
}

TEST_CASE("a bar that falls flat on end springs 3 k and k feels 0.966 and 0.947 v sqrt(k m)") {
  const double length = 5;
  CoupledPush push(falling(bar(length)), {below(-length / 2, 0), below(length / 2, 0)}, springs({3 * k, k}));
  CHECK(push.push() == CoupledPush::Stop::left);
  CHECK(push.peak_force()(0) / (v * std::sqrt(k * m)) == Approx(0.966).margin(5e-4));
  CHECK(push.peak_force()(1) / (v * std::sqrt(k * m)) == Approx(0.947).margin(5e-4));
  // Elastic: no energy is lost, and the bar turns now.
  const Vec3 spin = push.spin();
  CHECK(m * push.velocity().squaredNorm() / 2 + spin.dot(bar(length) * spin) / 2 ==
        Approx(m * v * v / 2).epsilon(1e-9));
  CHECK(std::abs(spin.y()) > 0.01);
}

TEST_CASE("one contact is the weight that drops on a spring: w + sqrt(w2 + k m v2)") {
  const double w = m * 9.81;
  CoupledPush push(falling(m * Mat3::Identity(), v, w), {below(0, 0)}, springs({k}));
  CHECK(push.push() == CoupledPush::Stop::left);
  CHECK(push.peak_force()(0) == Approx(w + std::sqrt(w * w + k * m * v * v)).epsilon(1e-9));
  // From rest the peak is twice the weight, and the contact never lets go.
  CoupledPush laid(falling(m * Mat3::Identity(), 0, w), {below(0, 0)}, springs({k}));
  CHECK(laid.push() == CoupledPush::Stop::held);
  CHECK(laid.peak_force()(0) == Approx(2 * w).epsilon(1e-9));
}

TEST_CASE("contacts that share a structure, a tilted body and partings agree with small steps") {
  PushingBody body = falling(Vec3(90, 150, 210).asDiagonal(), v, m * 9.81);
  body.spin = Vec3(0.8, -0.5, 0.2);
  const std::vector<PushedPlace> places{below(1, 0.8), below(-1.2, 0.7), below(0.2, -1)};
  Eigen::MatrixXd compliance(3, 3);
  compliance << 5e-7, 1e-7, 0.5e-7, 1e-7, 8e-7, 2e-7, 0.5e-7, 2e-7, 3e-7;
  CoupledPush push(body, places, compliance);
  const auto stop = push.push();
  CHECK(stop == CoupledPush::Stop::left);

  // Velocity Verlet, with the forces of the contacts that still push.
  Eigen::MatrixXd J(3, 6);
  for (int i = 0; i < 3; ++i)
    J.row(i) << places[i].normal.transpose(), places[i].point.cross(places[i].normal).transpose();
  Eigen::Matrix<double, 6, 6> inverse = Eigen::Matrix<double, 6, 6>::Zero();
  inverse.topLeftCorner<3, 3>() = Mat3::Identity() / m;
  inverse.bottomRightCorner<3, 3>() = body.inertia.inverse();
  std::vector<int> touching{0, 1, 2};
  Eigen::Matrix<double, 6, 1> q = Eigen::Matrix<double, 6, 1>::Zero(), rate, weight;
  rate << body.velocity, body.spin;
  weight << body.weight, Vec3::Zero();
  Eigen::Vector3d peak = Eigen::Vector3d::Zero();
  const double dt = 2e-6;
  for (long step = 0; step < 200'000 && !touching.empty(); ++step) {
    const auto force = [&] {
      Eigen::Vector3d f = Eigen::Vector3d::Zero();
      const Eigen::MatrixXd part = compliance(touching, touching);
      const Eigen::VectorXd depth = J * q, own = depth(touching), pushed = part.inverse() * own;
      f(touching) = pushed;
      return f;
    };
    const Eigen::Vector3d f = force();
    peak = peak.cwiseMax(f);
    if (step > 0) std::erase_if(touching, [&](int i) { return f(i) < 0; });
    if (touching.empty()) break;
    rate += dt * (inverse * (weight - J.transpose() * f.cwiseMax(0.0)));
    q += dt * rate;
  }
  for (int i = 0; i < 3; ++i) CHECK(push.peak_force()(i) == Approx(peak(i)).epsilon(1e-4));
  CHECK((push.velocity() - rate.head<3>()).norm() < 1e-3 * v);
  CHECK((push.spin() - rate.tail<3>()).norm() < 1e-3 * v);
}

TEST_CASE("a push ends where what bears it fails, and goes on with what is left") {
  const double bearable = 0.4 * v * std::sqrt(k * m) / 2;
  CoupledPush push(falling(m * Mat3::Identity()), {below(1, 0), below(-1, 0)}, springs({k / 2, k / 2}));
  const auto used = [&](const Eigen::VectorXd& force) { return force.maxCoeff() / bearable; };
  CHECK(push.push(used) == CoupledPush::Stop::failed);
  CHECK(push.force()(0) == Approx(bearable).epsilon(1e-9));
  // By energy: two springs of k/2 have taken up F2/k each.
  CHECK(push.velocity().z() == Approx(-std::sqrt(v * v - 2 * 2 * bearable * bearable / k / m)).epsilon(1e-9));
  CHECK(push.stored() == Approx(2 * bearable * bearable / k).epsilon(1e-9));
}

TEST_CASE("a push without a place, a mass or a compliance is refused") {
  CHECK_THROWS_AS(CoupledPush(falling(Mat3::Identity()), {}, Eigen::MatrixXd()), std::invalid_argument);
  CHECK_THROWS_AS(CoupledPush(falling(Mat3::Zero()), {below(0, 0)}, springs({k})), std::invalid_argument);
  CHECK_THROWS_AS(CoupledPush(falling(Mat3::Identity()), {below(0, 0)}, springs({-k})), std::invalid_argument);
}

TEST_CASE("a push at one place that takes the structure's mass along is the law for one place") {
  const double w = m * 9.81, share = 120;
  CoupledPush push(falling(m * Mat3::Identity(), v, w), {below(0, 0)}, springs({k}),
                   Eigen::MatrixXd::Constant(1, 1, share));
  CHECK(push.push() == CoupledPush::Stop::left);
  Indentation alone(m, v, w, share);
  CHECK(alone.push(1 / k, unlimited) == Indentation::Stop::stood);
  CHECK(push.peak_force()(0) == Approx(alone.peak_force()).epsilon(1e-9));
  // It stands still where most is stored: the speed there is found to the square root of what the energy is.
  CHECK(push.rates_at_most_stored().norm() < 1e-6 * v);
}

TEST_CASE("masses that move with two places take their shares of a turning body at once") {
  // A bar on two equal springs, a mass under each end: half of the bar's mass moves with each end, and they do not feel
  // each other when the bar's inertia is that of two halves at its ends.
  const double length = 5, share = 70;
  const Mat3 dumbbell = Vec3(1, m * length * length / 4, m * length * length / 4).asDiagonal();
  PushingBody body = falling(dumbbell);
  body.spin = Vec3(0, 2 * v / length / 2, 0);  // one end comes with half of v more, the other with half less
  CoupledPush push(body, {below(-length / 2, 0), below(length / 2, 0)}, springs({k, k}),
                   Vec2(share, share).asDiagonal());
  CHECK(push.push() == CoupledPush::Stop::left);
  const double moving = m / 2 + share;
  for (const auto& [end, speed] : {std::pair(0, 0.5 * v), std::pair(1, 1.5 * v)})
    CHECK(push.peak_force()(end) == Approx(speed * (m / 2) / moving * std::sqrt(k * moving)).epsilon(1e-9));
}
