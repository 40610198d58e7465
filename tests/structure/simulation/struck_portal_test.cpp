// A mass strikes a post of a portal that moves, against an integration of the same plane frame with a spring between
// the two: elements written out here, steps of a microsecond.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "structure/ballistic_world.h"
#include "structure/frame_builder.h"
#include "structure/simulation_run.h"
#include "structure/struck_post.h"
#include "topple/structure/simulation.h"

namespace {

using namespace topple::test;
using Mat6d = Eigen::Matrix<double, 6, 6>;
using Vec6d = Eigen::Matrix<double, 6, 1>;

constexpr double height = 3, span = 4, at = 1.2, E = 200e9, I = 2e-4, A = 0.04, density = 7850;
constexpr double body_mass = 300;

/// `limit`: of the struck post's foot, rad; with it that yields, and all else holds.
FrameBuilder portal(double capacity, double limit = 0) {
  FrameBuilder frame;
  JointCapacity joint = same_capacity(unlimited);
  joint.value[5] = joint.value[6] = capacity;
  JointCapacity foot = joint;
  if (limit > 0) {
    foot.ductility[5] = foot.ductility[6] = limit;
    joint = same_capacity(unlimited);
  }
  const NodeId foot1 = frame.node("F1", 0, 0, 0), foot2 = frame.node("F2", span, 0, 0),
               top1 = frame.node("T1", 0, 0, height), top2 = frame.node("T2", span, 0, height);
  // The post has a joint at its foot alone, as in the buildings: above, what meets it breaks off from it.
  frame.member("post", MemberKind::post, foot1, top1, foot, {});
  frame.member("other", MemberKind::post, foot2, top2, joint, {});
  frame.member("beam", MemberKind::beam, top1, top2, joint, joint);
  frame.support(foot1);
  frame.support(foot2);
  frame.self_weight(density);
  return frame;
}

/// Of a bar from end 0 to end 1: axial, transverse, rotation at each (J. S. Przemieniecki, Theory of Matrix Structural
/// Analysis, 1968).
Mat6d stiffness(double L) {
  const double a = E * A / L, b = 12 * E * I / (L * L * L), c = 6 * E * I / (L * L), d = 4 * E * I / L;
  Mat6d K;
  K << a, 0, 0, -a, 0, 0,     //
      0, b, c, 0, -b, c,      //
      0, c, d, 0, -c, d / 2,  //
      -a, 0, 0, a, 0, 0,      //
      0, -b, -c, 0, b, -c,    //
      0, c, d / 2, 0, -c, d;
  return K;
}
Mat6d consistent_mass(double L) {
  const double m = density * A * L / 420;
  Mat6d M;
  M << 140, 0, 0, 70, 0, 0,                         //
      0, 156, 22 * L, 0, 54, -13 * L,               //
      0, 22 * L, 4 * L * L, 0, 13 * L, -3 * L * L,  //
      70, 0, 0, 140, 0, 0,                          //
      0, 54, 13 * L, 0, 156, -22 * L,               //
      0, -13 * L, -3 * L * L, 0, -22 * L, 4 * L * L;
  return m * M;
}
/// Axial u, transverse w, rotation of both ends from (x, z, turn about -y: transverse to axial) of two nodes.
Mat6d along(double cosine, double sine) {
  Mat6d T = Mat6d::Zero();
  for (int end = 0; end < 2; ++end) {
    T.block<2, 2>(3 * end, 3 * end) << cosine, sine, -sine, cosine;
    T(3 * end + 2, 3 * end + 2) = 1;
  }
  return T;
}

/// The portal in its plane: both tops move, x, z and turn of each. The post that is struck hangs on its top alone once
/// its foot has broken.
class Portal {
 public:
  Portal() { assemble(); }

  struct Break {
    std::string joint;
    double time;
  };
  struct Answer {
    double peak = 0;
    double corner = 0;  ///< largest moment at the beam's near end
    double turned = 0;  ///< of a foot that yields, rad
    std::vector<Break> breaks;
    double speed = 0;  ///< of the body at the end
  };
  /// Until the body has let go for good, and `after` from then on.
  Answer strike(double speed, double capacity, double after, bool yields = false) {
    Answer answer;
    Vec6d u = Vec6d::Zero(), v = Vec6d::Zero();
    double x = 0, moving = speed, offset = 0, t = 0, parted = -1;
    const double h = 1e-6;
    while (parted < 0 || t < parted + after) {
      const auto force = [&](const Vec6d& place, double body) {
        return std::max(0.0, (body - g.dot(place) - offset - foot_per_force() * turned) / give);
      };
      const auto rate = [&](const Vec6d& place, double body, Vec6d& frame_rate, double& body_rate) {
        const double F = force(place, body);
        frame_rate = inverse * (F * g - K * place + turned * foot_per_motion());
        body_rate = -F / body_mass;
      };
      Vec6d a1, a2, a3, a4;
      double b1, b2, b3, b4;
      rate(u, x, a1, b1);
      rate(u + h / 2 * v, x + h / 2 * moving, a2, b2);
      rate(u + h / 2 * v + h * h / 4 * a1, x + h / 2 * moving + h * h / 4 * b1, a3, b3);
      rate(u + h * v + h * h / 2 * a2, x + h * moving + h * h / 2 * b2, a4, b4);
      u += h * v + h * h / 6 * (a1 + a2 + a3);
      v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      x += h * moving + h * h / 6 * (b1 + b2 + b3);
      moving += h / 6 * (b1 + 2 * b2 + 2 * b3 + b4);
      t += h;
      const double F = force(u, x);
      if (yields) {
        // Back to its capacity, at the motion and the place of the body as they are.
        const double stiff = 4 * E * I / height, moment = moment_of_foot(u, F) - stiff * turned;
        const double s = foot_per_force(), over = std::abs(moment) - capacity;
        if (over > 0) turned += std::copysign(over, moment) / (stiff + (F > 0 ? s * s / give : 0));
      }
      answer.peak = std::max(answer.peak, F);
      if (F == 0 && parted < 0 && t > 1e-4) parted = t;
      const double corner = moment_of_beam(u);
      if (beam_holds) answer.corner = std::max(answer.corner, std::abs(corner));
      // The first over capacity breaks; the body stays pressed in as far as it was.
      const double pressed = x - g.dot(u) - offset;
      if (yields) continue;
      if (foot_holds && std::abs(moment_of_foot(u, F)) > capacity) {
        foot_holds = false;
        answer.breaks.push_back({"post:1", t});
      } else if (beam_holds && std::abs(corner) > capacity) {
        beam_holds = false;
        answer.breaks.push_back({"beam:1", t});
      } else {
        continue;
      }
      if (!foot_holds && !beam_holds) break;  // the post is free
      assemble();
      offset = x - g.dot(u) - pressed;
    }
    answer.speed = moving;
    answer.turned = turned;
    return answer;
  }

 private:
  void assemble() {
    K.setZero();
    Mat6d M = Mat6d::Zero();
    // Up a post the axis is z and the transverse direction -x; turns count from axis to transverse.
    const Mat6d up = along(0, 1), across = along(1, 0);
    const Mat6d post_K = up.transpose() * stiffness(height) * up,
                post_M = up.transpose() * consistent_mass(height) * up;
    const Mat6d beam_K = across.transpose() * stiffness(span) * across,
                beam_M = across.transpose() * consistent_mass(span) * across;
    const double post_mass = density * A * height, b = height - at;
    K.block<3, 3>(3, 3) += post_K.block<3, 3>(3, 3);
    M.block<3, 3>(3, 3) += post_M.block<3, 3>(3, 3);
    g.setZero();
    const double squeeze = std::sqrt(A) / (E * A);
    if (foot_holds) {
      K.block<3, 3>(0, 0) += post_K.block<3, 3>(3, 3);
      M.block<3, 3>(0, 0) += post_M.block<3, 3>(3, 3);
      // Built in at both ends, pushed along x (against the transverse direction) at `at`.
      g(0) = at * at * (3 * b + at) / std::pow(height, 3);
      g(2) = at * at * b / (height * height);
      give = std::pow(at * b, 3) / (3 * E * I * std::pow(height, 3)) + squeeze;
    } else {
      Eigen::Matrix3d rigid = post_mass * Eigen::Matrix3d::Identity();
      rigid(2, 2) = post_mass * height * height / 3;
      rigid(0, 2) = rigid(2, 0) = post_mass * height / 2;  // a turn carries what is below towards +x
      M.block<3, 3>(0, 0) += rigid;
      g(0) = 1;
      g(2) = b;
      give = b * b * b / (3 * E * I) + squeeze;
    }
    if (beam_holds) {
      K += beam_K;
      M += beam_M;
    } else {
      // Its mass hangs on the far top.
      const double mass = density * A * span;
      M.block<3, 3>(3, 3) += mass * Eigen::Vector3d(1, 1, span * span / 3).asDiagonal().toDenseMatrix();
      M(4, 5) -= mass * span / 2;
      M(5, 4) -= mass * span / 2;
    }
    inverse = M.inverse();
  }
  [[nodiscard]] double moment_of_foot(const Vec6d& u, double F) const {
    const double b = height - at;
    Vec6d ends = Vec6d::Zero();
    ends.tail<3>() = u.head<3>();
    const Vec6d forces = stiffness(height) * (along(0, 1) * ends);
    return forces(2) + F * at * b * b / (height * height);
  }
  /// What a newton on the post brings to its foot, nodes held, and what motions of the frame do.
  [[nodiscard]] double foot_per_force() const { return at * std::pow(height - at, 2) / (height * height); }
  [[nodiscard]] Vec6d foot_per_motion() const {
    Vec6d row = Vec6d::Zero();
    row.head<3>() = (stiffness(height) * along(0, 1)).row(2).tail<3>();
    return row;
  }
  [[nodiscard]] double moment_of_beam(const Vec6d& u) const { return (stiffness(span) * (along(1, 0) * u))(2); }

  Mat6d K, inverse;
  Vec6d g;
  double give = 0, turned = 0;
  bool foot_holds = true, beam_holds = true;
};

}  // namespace

TEST_CASE(
    "A mass that strikes a portal at three speeds: peak and order of breaks as integrated with a contact spring") {
  const double capacity = 4e5;
  for (const double speed : {2.0, 6.0, 20.0}) {
    const Portal::Answer exact = Portal().strike(speed, capacity, 0.05);
    for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
      Simulation simulation(portal(capacity).building, struck_post(at, speed, body_mass, step, 0.4),
                            {1, [] { return std::make_unique<BallisticWorld>(); }});
      run(simulation);
      const auto impacts = of_kind(simulation, SimulationEvent::Kind::impact);
      REQUIRE(!impacts.empty());
      std::string order, expected;
      for (const SimulationEvent& event : of_kind(simulation, SimulationEvent::Kind::joint_broke))
        if (event.name == "post:1" || event.name == "beam:1") order += event.name + " ";
      for (const Portal::Break& one : exact.breaks) expected += one.joint + " ";
      INFO("speed " << speed << ", step " << step << ": peak " << impacts[0].peak_force << " against " << exact.peak
                    << ", breaks " << order << "against " << expected << ", corner "
                    << simulation.frame().largest_utilisation_so_far(JointId(4u)) * capacity << " against "
                    << exact.corner << ", speed out " << impacts[0].speed_out << ", body " << exact.speed);
      CHECK(impacts[0].peak_force == Approx(exact.peak).epsilon(0.05));
      CHECK(order == expected);
      CHECK(simulation.ledger().momentum_error < 1e-10);
    }
  }
}

TEST_CASE("A mass that strikes a portal whose foot yields: peak and turn as integrated with an elastic-plastic hinge") {
  const double capacity = 4e5;
  for (const double speed : {6.0, 12.0}) {
    const Portal::Answer exact = Portal().strike(speed, capacity, 0, true);
    REQUIRE(std::abs(exact.turned) > 1e-3);
    // Its limit tells how far it has turned when the push ends.
    for (const double share : {0.9, 1.1}) {
      Simulation simulation(portal(capacity, share * std::abs(exact.turned)).building,
                            struck_post(at, speed, body_mass, 1.0 / 60, 0.4),
                            {1, [] { return std::make_unique<BallisticWorld>(); }});
      run(simulation);
      const auto impacts = of_kind(simulation, SimulationEvent::Kind::impact);
      REQUIRE(!impacts.empty());
      int broken = 0;
      for (const SimulationEvent& event : of_kind(simulation, SimulationEvent::Kind::joint_broke))
        broken += event.joint.cause == BreakCause::impact ? 1 : 0;
      INFO("speed " << speed << ": peak " << impacts[0].peak_force << " against " << exact.peak << ", limit "
                    << share * exact.turned);
      CHECK(broken == (share < 1 ? 1 : 0));
      CHECK(impacts[0].peak_force == Approx(exact.peak).epsilon(0.05));
      CHECK(simulation.ledger().lost_in_impacts >= 0);
      CHECK(std::abs(simulation.ledger().residual()) < 1e-6);
    }
  }
}
