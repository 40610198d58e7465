// What a push at several places did to a body, as impulses: consistent, least, and never more than the push had.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "simulation/impact/push_impulses.h"

namespace {

using namespace topple::structure;
using Vec6 = CoupledPush::Vec6;

double energy(const PushingBody& body, const Vec6& rates) {
  return (body.mass * rates.head<3>().squaredNorm() + rates.tail<3>().dot(body.inertia * rates.tail<3>())) / 2;
}

Vec6 rates_of(const PushingBody& body) {
  Vec6 rates;
  rates << body.velocity, body.spin;
  return rates;
}

/// Half a building on beams of two floors: six places, their normals upright but for what angles are known by.
struct OnBeams {
  PushingBody body;
  std::vector<PushedPlace> places;
};

OnBeams on_beams(std::mt19937& random, double tilt) {
  std::normal_distribution<double> any;
  OnBeams scene;
  scene.body.mass = 883e3;
  scene.body.inertia = Eigen::Vector3d(6e7, 7e7, 9e7).asDiagonal();
  scene.body.centre = {9, 12, 16};
  scene.body.velocity = {0.1 * any(random), 0.1 * any(random), -1.7};
  scene.body.spin = {0.01 * any(random), 0.01 * any(random), 0.001};
  for (const Vec3& point : {Vec3(0, 15, 10.7), Vec3(9, 24, 10.7), Vec3(18, 21, 7.2), Vec3(18, 9, 7.2),
                            Vec3(18, 15, 7.2), Vec3(3, 24, 10.7)})
    scene.places.push_back({point, Vec3(tilt * any(random), tilt * any(random), -1).normalized()});
  return scene;
}

}  // namespace

TEST_CASE("a push that places brought about is found again as impulses along their normals") {
  std::mt19937 random(1);
  const OnBeams scene = on_beams(random, 0.3);
  Vec6 out = rates_of(scene.body);
  const std::array<double, 6> given{-1e4, -3e4, -2e4, -5e3, 0, -1e3};
  for (std::size_t i = 0; i < scene.places.size(); ++i) {
    const PushedPlace& place = scene.places[i];
    out.head<3>() += given[i] * place.normal / scene.body.mass;
    out.tail<3>() += scene.body.inertia.inverse() * (place.point - scene.body.centre).cross(place.normal) * given[i];
  }
  const PushImpulses found = impulses_of_push(scene.body, scene.places, out, std::vector<char>(6, 0));
  for (std::size_t i = 0; i < given.size(); ++i)
    CHECK(found.along(static_cast<Eigen::Index>(i)) == Approx(given[i]).epsilon(1e-9).margin(1e-4));
  CHECK((rates_of(scene.body) + found.change - out).norm() < 1e-12 * out.norm());
}

TEST_CASE("what weight did across the normals is no impulse") {
  PushingBody body{100, 10 * Mat3::Identity(), Vec3::Zero(), Vec3(2, 0, 0), Vec3::Zero(), Vec3(0, 0, -981)};
  Vec6 out;
  out << -0.5, 0, -0.7, 0, 0, 0;
  const PushImpulses found = impulses_of_push(body, std::vector<PushedPlace>{{Vec3(1, 0, 0), Vec3(1, 0, 0)}}, out, {0});
  CHECK(found.along(0) == Approx(-250));
  CHECK(found.change(0) == Approx(-2.5));
  CHECK(found.change.tail<5>().norm() == 0);
}

TEST_CASE("normals that nearly depend on each other give a body no more than the push had") {
  // Some places have given way: the speeds wanted of them fit no motion of the body, and solving for them all would
  // take a tilt of 1e-5 for a direction of its own.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> logarithm(-9, 0);
  for (int trial = 0; trial < 2000; ++trial) {
    const OnBeams scene = on_beams(random, std::pow(10, logarithm(random)));
    const Vec6 in = rates_of(scene.body);
    Vec6 out = 0.3 * in;
    out(2) = trial % 2 == 0 ? -2.2 : -0.4;
    out(4) += 0.02;
    std::vector<char> through(6);
    for (char& one : through) one = random() % 2 == 0 ? 1 : 0;
    const PushImpulses found = impulses_of_push(scene.body, scene.places, out, through);
    INFO("trial " << trial);
    // What is left out as dependent, 1e-5 of the largest, is not taken out of the rest.
    REQUIRE(energy(scene.body, found.change) <= energy(scene.body, out - in) * (1 + 1e-4));
    Vec6 momentum = Vec6::Zero();
    for (std::size_t i = 0; i < scene.places.size(); ++i) {
      const PushedPlace& place = scene.places[i];
      const double size = found.along(static_cast<Eigen::Index>(i));
      momentum.head<3>() += size * place.normal;
      momentum.tail<3>() += size * (place.point - scene.body.centre).cross(place.normal);
    }
    Vec6 got;
    got << scene.body.mass * found.change.head<3>(), scene.body.inertia * found.change.tail<3>();
    REQUIRE((momentum - got).norm() <= 1e-10 * scene.body.mass * in.norm() * 10);
  }
}

TEST_CASE("a place that has given way pushes the body no faster than it came") {
  std::mt19937 random(3);
  const OnBeams scene = on_beams(random, 1e-3);
  Vec6 out = rates_of(scene.body);
  out(2) -= 0.5;  // weight drew it on while joints broke
  const PushImpulses free = impulses_of_push(scene.body, scene.places, out, std::vector<char>(6, 0));
  const PushImpulses held = impulses_of_push(scene.body, scene.places, out, std::vector<char>(6, 1));
  CHECK(free.change(2) == Approx(-0.5).epsilon(1e-3));
  CHECK(std::abs(held.change(2)) < 1e-6);
}
