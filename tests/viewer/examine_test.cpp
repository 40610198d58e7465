// What is drawn upon the structure to examine it: diagrams, arrows, segments, modes.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>

#include "app/open_scene.h"
#include "app/session.h"
#include "app/show_words.h"
#include "renderer/instances/scene_instances.h"
#include "renderer/shapes/arrows.h"
#include "renderer/shapes/diagram.h"
#include "support/scratch_folder.h"
#include "topple/structure/error.h"

namespace {

using namespace topple::viewer;
using topple::structure::MemberId;

/// A member of length 4 along global x, its z up.
MemberInstance bar() {
  MemberInstance member{};
  member.rotation = {0, 0, 0, 1};
  member.length = 4;
  return member;
}

float highest(const Overlay& overlay) {
  float z = 0;
  for (const OverlayVertex& v : overlay.triangles) z = std::max(z, v.position.z);
  return z;
}
float lowest(const Overlay& overlay) {
  float z = 0;
  for (const OverlayVertex& v : overlay.triangles) z = std::min(z, v.position.z);
  return z;
}

}  // namespace

TEST_CASE("a moment is drawn on the side that it tenses, to scale, and split where it changes sign") {
  Overlay overlay;
  const float values[] = {-200, 100, -200};
  add_diagram(overlay, bar(), values, 2, 4, 0.001F);
  CHECK(highest(overlay) == Approx(0.1F));
  CHECK(lowest(overlay) == Approx(-0.2F));
  // From -200 to 100 over a half of 4 m: zero after 2/3 of it.
  bool crosses = false;
  for (const OverlayVertex& v : overlay.lines)
    crosses = crosses || (v.position.z == 0 && std::abs(v.position.x - 4.0F / 3) < 1e-5F);
  CHECK(crosses);
  CHECK(diagram_direction(5) == glm::vec3(0, -1, 0));  // moment_z above zero tenses the side of -y
}

TEST_CASE("arrows are as long as their share of the largest and end where they act") {
  FrameForces forces;
  forces.points = {{{1, 2, 3}, {0, 0, -100}}, {{4, 5, 6}, {50, 0, 0}}, {{0, 0, 0}, {0.5F, 0, 0}}};
  ViewOptions options;
  CHECK(arrow_instances(forces, options, {0, 0, 0}, 2).empty());
  options.loads = true;
  const auto arrows = arrow_instances(forces, options, {0, 0, 1}, 2);
  REQUIRE(arrows.size() == 2);  // what is far below the largest is left out
  CHECK(arrows[0].position == glm::vec3(1, 2, 4));
  CHECK(arrows[0].scale.z == 2);
  CHECK(arrows[1].position.x == Approx(3));
  CHECK(arrows[1].scale.z == Approx(1));
  CHECK(arrow_scale(forces).points == 100);
}

TEST_CASE("reactions on the drawing carry the building's weight") {
  const Scene scene = open_scene("seed_building");
  Session session(scene.building, scene.scenario);
  CHECK_FALSE(session.snapshot()->answer->forces);
  session.set_wanted({false, true});
  const auto snapshot = session.snapshot();
  REQUIRE(snapshot->answer->forces);
  double up = 0, down = 0;
  for (const auto& arrow : snapshot->answer->forces->reactions) up += static_cast<double>(arrow.force.z());
  const auto& frame = session.simulation().frame();
  for (std::size_t m = 0; m < scene.building->members.size(); ++m) down += frame.mass(MemberId(m));
  for (std::size_t p = 0; p < scene.building->panels.size(); ++p) down += frame.mass(topple::structure::PanelId(p));
  CHECK(up == Approx(down * scene.building->gravity).epsilon(1e-5));  // the arrows are in single precision
  CHECK_FALSE(snapshot->answer->forces->spread.empty());
  CHECK(snapshot->answer->forces->contacts.empty());
}

TEST_CASE("a cut part gets a segment colour of its own when it falls") {
  const Scene scene = open_scene("seed_building");
  Session session(scene.building, scene.scenario);
  CHECK(session.snapshot()->membership->segment[0] == 0);
  const MemberId post(0u);
  session.apply(topple::structure::RemoveTool{{post}, {}, {}});
  session.step();
  CHECK(session.snapshot()->membership->segment[0] == -1);
  CHECK(segment_colour(0, false) != segment_colour(1, false));
  CHECK(segment_colour(0, true) != segment_colour(1, true));
}

TEST_CASE("modes of vibration and buckling are found, lowest first") {
  const Scene scene = open_scene("seed_building");
  ModeShapes modes(scene.building, *scene.scenario.combination);
  for (const ModeKind kind : {ModeKind::vibration, ModeKind::buckling}) {
    const auto& found = modes.wait_for(kind);
    REQUIRE(found.size() >= 3);
    CHECK(found[0].value > 0);
    CHECK(found[0].value <= found[1].value);
    CHECK(found[0].shape->size() == scene.building->nodes.size());
  }
  // A steel frame of six storeys sways at about one hertz: 10 / storeys by the rule of thumb, loads included.
  CHECK(modes.wait_for(ModeKind::vibration)[0].value > 0.3);
  CHECK(modes.wait_for(ModeKind::vibration)[0].value < 3);
}

TEST_CASE("words choose the view, and wrong ones are refused with those accepted") {
  ViewOptions options;
  ModeView mode;
  show("diagram moment_z", options, mode);
  CHECK(options.diagram == 5);
  show("no diagram", options, mode);
  CHECK(options.diagram == -1);
  show("shear_y", options, mode);
  CHECK(options.colouring == Colouring::component);
  CHECK(options.component == 1);
  show("deflection 50", options, mode);
  CHECK(options.deflection_scale == 50);
  show("buckling 2", options, mode);
  CHECK(mode.kind == ModeKind::buckling);
  CHECK(mode.number == 1);
  show("no slabs", options, mode);
  show("uncoloured beams", options, mode);
  show("no shadows", options, mode);
  show("wall-opacity 0.3", options, mode);
  show("no yielded", options, mode);
  CHECK_FALSE(options.yielded_joints);
  show("yielded", options, mode);
  CHECK(options.yielded_joints);
  CHECK_FALSE(options.shown.slabs);
  CHECK(options.shown.walls);
  CHECK_FALSE(options.coloured.beams);
  CHECK(options.shown.beams);
  CHECK_FALSE(options.shadows);
  CHECK(options.wall_opacity == 0.3F);
  show("slabs", options, mode);
  show("coloured beams", options, mode);
  CHECK(options.shown == PartSwitches());
  CHECK(options.coloured == PartSwitches());
  const auto refused = [&](const std::string& words) {
    try {
      show(words, options, mode);
    } catch (const topple::structure::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refused("moments").find("accepted: ") != std::string::npos);
  CHECK(refused("deflection far").find("'far' is no number") != std::string::npos);
  CHECK(refused("vibration 99").find("from 1 to 8") != std::string::npos);
  CHECK(refused("diagram stress").find("no such view") != std::string::npos);
}

TEST_CASE("a post between nodes that rest bulges in its buckling mode") {
  // Two posts over each other, fixed at foot and head, held sideways between: each buckles inside.
  const topple::test::ScratchFolder folder;
  const std::string file = (folder / "posts.json").string();
  std::ofstream(file)
      << R"({"topple": 1, "materials": {"steel": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
    "sections": {"post": {"shape": "box", "depth": 0.1, "width": 0.1, "thickness": 0.005}},
    "joints": {"full": {"capacity": {"tension": 1e6, "compression": 1e6, "shear_y": 1e6, "shear_z": 1e6, "torsion": 1e6,
                                     "moment_y": 1e6, "moment_z": 1e6}}},
    "nodes": {"A": [0, 0, 0], "B": [0, 0, 4], "C": [0, 0, 8]},
    "members": {"P1": {"kind": "post", "nodes": ["A", "B"], "section": "post", "material": "steel", "joints": ["full", "full"]},
                "P2": {"kind": "post", "nodes": ["B", "C"], "section": "post", "material": "steel", "joints": ["full", "full"]}},
    "supports": {"A": {"x": true, "y": true, "z": true, "rx": true, "ry": true, "rz": true},
                 "B": {"x": true, "y": true, "rx": true, "ry": true}, "C": {"x": true, "y": true, "rx": true, "ry": true, "rz": true}},
    "loads": {"push": {"nodes": {"C": {"z": -1e5}}}}, "combinations": {"service": {"push": 1}}})";
  const Scene scene = open_scene(file);
  ModeShapes modes(scene.building, topple::structure::CombinationId(0u));
  const auto& found = modes.wait_for(ModeKind::buckling);
  INFO(modes.error(ModeKind::buckling));
  REQUIRE(found.size() >= 2);
  // Euler, fixed at both ends: 4 pi2 E I / L2, I = (0.1^4 - 0.09^4) / 12; less by what shear gives, about two percent.
  const double euler = 4 * 9.8696044 * 210e9 * (1e-4 - 0.6561e-4) / 12 / 16 / 1e5;
  CHECK(found[0].value == Approx(euler).epsilon(0.03));
  REQUIRE(found[0].bulge);
  float most = 0;
  for (const auto& node : *found[0].shape) CHECK(node.norm() < 1e-6F);  // the nodes rest
  for (const Eigen::Vector3f& bulge : *found[0].bulge) {
    CHECK(std::abs(bulge.z()) < 1e-6F);
    most = std::max(most, bulge.norm());
  }
  // The largest translation, 1, is asked for at 0.45 of the height: in the middle (1 - cos) / 2 is 2.5 % more.
  CHECK(most == Approx(1.0).epsilon(0.04));
  // And it is drawn.
  Snapshot snapshot = undeformed(*scene.building);
  snapshot.shape = found[0].shape;
  snapshot.shape_bulge = found[0].bulge;
  snapshot.shape_scale = 0.5F;
  SceneInstances instances(*scene.building);
  instances.update(snapshot, ViewOptions());
  float drawn = 0;
  for (const auto& batch : instances.members())
    for (const auto& member : batch.instances) drawn = std::max(drawn, glm::length(member.bulge));
  CHECK(drawn == Approx(0.5F * most).epsilon(1e-4));
}
