// Members are drawn as the analysis has them: behind hinges that yielded, releases and broken joints, against the
// closed forms of beams; and what lets go keeps the shape of that moment.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "../structure/frame_builder.h"
#include "../structure/unbraced_rules.h"
#include "app/open_scene.h"
#include "app/session.h"
#include "renderer/instances/scene_instances.h"
#include "topple/structure/member_shapes.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;
using namespace topple::viewer;

constexpr double EI = 200e9 * 2e-4;  // N m2, of FrameBuilder's bar in its xz plane
constexpr double single = 1e-5;      // of single precision, and of the fit through three places

std::vector<Displacement> displacements(const Building& building, const StandingFrame& standing) {
  std::vector<Displacement> all;
  for (std::size_t n = 0; n < building.nodes.size(); ++n) all.push_back(standing.displacement(NodeId(n)).cast<float>());
  return all;
}

MemberShape shape_now(const Building& building, const StandingFrame& standing, MemberId member) {
  return topple::structure::member_shape(standing, building, member, displacements(building, standing));
}

/// Built in at A, under its own weight of 2 kN/m (it bends about y); by what is told at B.
struct Beam {
  static constexpr double length = 6, weight = 2e3;
  FrameBuilder frame;
  MemberId member;
  Beam() {
    frame.self_weight(weight / 10 / 0.04);
    const NodeId a = frame.node("A", 0, 0, 3), b = frame.node("B", length, 0, 3);
    member = frame.member("AB", MemberKind::beam, a, b, same_capacity(1e12), same_capacity(1e12));
    frame.support(a);
    frame.support(b);
  }
  [[nodiscard]] JointId end(int which) const { return frame.building.joint(member, which); }
};

/// Of the middle, from the first end's place.
double middle_of(const MemberShape& shape, double length) {
  return static_cast<double>((shape.ends[0](2) + shape.ends[1](2)) / 2) +
         length / 8 * static_cast<double>(shape.ends[1](4) - shape.ends[0](4)) + static_cast<double>(shape.bulge.z());
}

}  // namespace

TEST_CASE("a beam between stiff joints sags between its nodes, one with a pin turns at it") {
  Beam beam;
  const double length = Beam::length, w = Beam::weight;
  SECTION("built in at both ends: w L4/384 EI") {
    const StandingFrame standing(beam.frame.building, CombinationId(0u), unbraced_rules());
    const MemberShape shape = shape_now(beam.frame.building, standing, beam.member);
    CHECK(middle_of(shape, length) == Approx(-w * std::pow(length, 4) / (384 * EI)).epsilon(single));
    CHECK(std::abs(shape.ends[0](4)) < single * 1e-3);
  }
  SECTION("pinned at one end: it turns there by w L3/48 EI, and sags by w L4/192 EI in the middle") {
    beam.frame.building.joints[1].stiffness(4) = 0;
    const StandingFrame standing(beam.frame.building, CombinationId(0u), unbraced_rules());
    const MemberShape shape = shape_now(beam.frame.building, standing, beam.member);
    CHECK(shape.ends[1](4) == Approx(-w * std::pow(length, 3) / (48 * EI)).epsilon(single));
    CHECK(middle_of(shape, length) == Approx(-w * std::pow(length, 4) / (192 * EI)).epsilon(single));
  }
  SECTION("broken off at one end it hangs from the other: by w L4/8 EI, turned by w L3/6 EI") {
    StandingFrame standing(beam.frame.building, CombinationId(0u), unbraced_rules());
    standing.break_joint(beam.end(0), BreakCause::tool);
    (void)standing.settle();
    const MemberShape shape = shape_now(beam.frame.building, standing, beam.member);
    CHECK(shape.ends[0](2) == Approx(-w * std::pow(length, 4) / (8 * EI)).epsilon(single));
    CHECK(shape.ends[0](4) == Approx(-w * std::pow(length, 3) / (6 * EI)).epsilon(single));
    CHECK(shape.ends[1].norm() < single * 1e-3F);
    CHECK(middle_of(shape, length) == Approx(-17 * w * std::pow(length, 4) / (384 * EI)).epsilon(single));
  }
}

TEST_CASE("a root that yields is drawn turned by what its hinge has turned, on the way and at rest") {
  // A cantilever without mass and a weight on its tip, which a prop bears until it goes.
  constexpr double length = 3, weight = 3e5, share = 0.8;
  FrameBuilder frame;
  const NodeId wall = frame.node("W", 0, 0, 3), foot = frame.node("F", length, 0, 0),
               tip = frame.node("T", length, 0, 3);
  JointCapacity root = same_capacity(1e12);
  root.value[5] = weight * length / share;
  root.ductility[5] = 1;
  const MemberId beam = frame.member("beam", MemberKind::beam, wall, tip, root, same_capacity(1e12));
  const MemberId prop = frame.member("prop", MemberKind::post, foot, tip, same_capacity(1e12), same_capacity(1e12));
  frame.support(wall);
  frame.support(foot);
  frame.load(tip, (Vec6() << 0, 0, -weight, 0, 0, 0).finished());
  StandingFrame standing(frame.building, CombinationId(0u), unbraced_rules());
  standing.let_move(1.0 / 60);
  standing.break_joint(frame.building.joint(prop, 1), BreakCause::tool);
  double most = 0;
  for (int n = 0; n < 3600 && (n == 0 || standing.pending()); ++n) {
    (void)standing.move();
    // A force F and a moment M at the tip turn it by F L2/2 EI + M L/EI against the root: the rest is the root's own.
    const auto forces = standing.end_forces(beam);
    const double bends = (forces(10) * length - forces(8) * length * length / 2) / EI;
    const double own = standing.displacement(tip)(4) - bends;
    const MemberShape shape = shape_now(frame.building, standing, beam);
    REQUIRE(static_cast<double>(shape.ends[0](4)) == Approx(own).margin(1e-6));
    REQUIRE(shape.ends[1](4) == Approx(standing.displacement(tip)(4)).margin(1e-6));
    REQUIRE(shape.ends[0].head<3>().norm() == 0);
    most = std::max(most, own);
  }
  REQUIRE_FALSE(standing.pending());
  CHECK(most > 0.02);
  const double stiffness = 3 * EI / std::pow(length, 3);
  const double turned = (-standing.displacement(tip).z() - weight / stiffness) / length;
  CHECK(shape_now(frame.building, standing, beam).ends[0](4) == Approx(turned).epsilon(1e-3));
}

TEST_CASE(
    "beside the nearest rigid motion a turned and moved part is not bent, and a kinked one is by half on each side") {
  const Eigen::Vector3d turn(0.001, -0.002, 0.003), way(0.4, 0.1, -0.2);
  const Eigen::Vector3d points[] = {{0, 0, 0}, {3, 0, 0}, {6, 0, 0}};
  const auto rigid = [&](const Eigen::Vector3d& at) {
    Displacement d;
    d << (way + turn.cross(at)).cast<float>(), turn.cast<float>();
    return d;
  };
  topple::structure::NearestMotion plain, kinked;
  Displacement down = Displacement::Zero();
  down(2) = -0.3F;  // of the middle: both halves turn by a tenth
  for (int i = 0; i < 3; ++i) {
    plain.add(points[i], rigid(points[i]));
    kinked.add(points[i], rigid(points[i]) + (i == 1 ? down : Displacement::Zero()));
  }
  plain.solve();
  kinked.solve();
  for (int i = 0; i < 3; ++i) {
    CHECK(plain.beside(points[i], rigid(points[i])).norm() < 1e-6F);
    const Displacement left = kinked.beside(points[i], rigid(points[i]) + (i == 1 ? down : Displacement::Zero()));
    CHECK(left(2) == Approx(i == 1 ? -0.2 : 0.1).epsilon(1e-4));
  }
}

TEST_CASE("what is left of a broken panel goes with its corners") {
  const Scene scene = open_scene("wall_hit");  // 6 m x 3 m on its lower edge, in the plane y = 0
  Session session(scene.building, scene.scenario);
  std::shared_ptr<const topple::viewer::Snapshot> now = session.snapshot();
  for (int i = 0; i < 90 && !now->membership->broken[0]; ++i) session.step(), now = session.snapshot();
  REQUIRE(now->membership->broken[0]);
  REQUIRE(now->membership->panel[0] == part_stands);
  // Its upper edge leans over by 0.3 m.
  const auto leaning = [&](float by) {
    topple::viewer::Snapshot moved = *now;
    auto answer = std::make_shared<FrameAnswer>(*now->answer);
    answer->displacements.assign(scene.building->nodes.size(), Displacement::Zero());
    for (const std::size_t corner : {2U, 3U})
      answer->displacements[static_cast<std::size_t>(scene.building->panels[0].nodes[corner].index)](1) = by;
    moved.answer = answer;
    return moved;
  };
  SceneInstances instances(*scene.building);
  const auto vertices = [&](float by) {
    instances.update(leaning(by), ViewOptions());
    for (const auto& batch : instances.chunks())
      if (!batch.instances.empty() && batch.instances[0].rest == glm::vec3(-instances.origin()))
        return batch.mesh.vertices;
    return std::vector<Vertex>();
  };
  const auto upright = vertices(0), leant = vertices(0.3F), back = vertices(0);
  REQUIRE(upright.size() > 20);
  REQUIRE(leant.size() == upright.size());
  for (std::size_t v = 0; v < upright.size(); ++v) {
    CHECK(leant[v].position.y - upright[v].position.y == Approx(0.3 * upright[v].position.z / 3).margin(1e-5));
    CHECK(leant[v].position.z == Approx(upright[v].position.z).margin(1e-5));
    CHECK(back[v].position == upright[v].position);
  }
}
