// Where a person begins: shipped scenes, files opened lately, a new building.
#include <imgui.h>
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>

#include "app/interface.h"
#include "app/start/building_plan.h"
#include "app/start/recent_files.h"
#include "app/start/shipped_scenes.h"
#include "app/start/start_page.h"
#include "renderer/frame_composer.h"
#include "renderer/gl_errors.h"
#include "renderer/headless_context.h"
#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/shipped_files.h"
#include "topple/structure/simulation.h"

namespace {

using namespace topple::viewer;
namespace structure = topple::structure;

/// Sets a variable of the environment for as long as it lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

structure::Building read(const BuildingPlan& plan) {
  return structure::parse_model(make_model_text(plan), "plan.json", structure::Purpose::demolish);
}

}  // namespace

TEST_CASE("every shipped scene has a title and a picture on the start page, the opening scene first") {
  const auto scenes = shipped_scenes();
  REQUIRE_FALSE(scenes.empty());
  CHECK(scenes.front().name == opening_scene);
  for (const ShippedScene& scene : scenes) {
    CAPTURE(scene.name);
    CHECK_FALSE(scene.title.empty());
    CHECK(std::filesystem::exists(scene.picture));
  }
  const auto listed = [&](const std::string& name) {
    return std::any_of(scenes.begin(), scenes.end(), [&](const ShippedScene& s) { return s.name == name; });
  };
  for (const std::string& name : structure::shipped_scenarios()) CHECK(listed(name));
  CHECK(listed("framed_tube_110"));  // no scenario shows it
  CHECK_FALSE(listed("wall"));       // wall_hit does
}

TEST_CASE("files opened lately are kept, the latest first, each once, and no more than there is room for") {
  const topple::test::ScratchFolder folder;
  const Variable state("XDG_STATE_HOME", folder.path().string());
  CHECK(recent_files().empty());
  remember_file("seed_hit");
  remember_file("town_house");
  remember_file("seed_hit");
  CHECK(recent_files() == std::vector<std::string>{"seed_hit", "town_house"});
  const std::filesystem::path own = folder / "own.json";
  std::ofstream(own) << "{}";
  remember_file(own.string());
  CHECK(recent_files().front() == own.string());
  std::filesystem::remove(own);
  CHECK(recent_files() == std::vector<std::string>{"seed_hit", "town_house"});
  for (int i = 0; i < 20; ++i) remember_file("scene" + std::to_string(i));
  CHECK(recent_files().size() == most_recent_files);
  CHECK(recent_files().front() == "scene19");
}

TEST_CASE("where the list of recent files is a pipe or a folder, nothing is kept, and nothing waits") {
  const topple::test::ScratchFolder folder;
  const Variable state("XDG_STATE_HOME", folder.path().string());
  std::filesystem::create_directories(recent_files_place().parent_path());
  REQUIRE(mkfifo(recent_files_place().c_str(), 0600) == 0);
  remember_file("seed_hit");
  CHECK(recent_files().empty());
  CHECK(std::filesystem::is_fifo(recent_files_place()));
  std::filesystem::remove(recent_files_place());
  std::filesystem::create_directory(recent_files_place());
  remember_file("seed_hit");
  CHECK(recent_files().empty());
  CHECK(std::filesystem::is_directory(recent_files_place()));
}

TEST_CASE("a building of the editor can be read, and stands under its loads, in concrete and in steel") {
  for (const FrameKind frame : {FrameKind::concrete, FrameKind::steel}) {
    CAPTURE(frame_names[static_cast<std::size_t>(frame)]);
    BuildingPlan plan;
    plan.frame = frame;
    plan.walls = {true, false, true, false};
    const structure::Building building = read(plan);
    // 4 x 3 posts on 3 storeys; beams along x: 3 spans on 3 lines, along y: 2 spans on 4; 6 bays; walls on x-: 2, on
    // y-: 3.
    CHECK(building.members.size() == 3 * (12 + 9 + 8));
    CHECK(building.panels.size() == 3 * (6 + 2 + 3));
    CHECK(building.title == "My building");
    structure::Simulation simulation(building, structure::idle_scenario(building));
    for (int i = 0; i < 3; ++i) simulation.step();
    for (const structure::SimulationEvent& event : simulation.events())
      CHECK(event.kind != structure::SimulationEvent::Kind::joint_broke);
    CHECK(simulation.bodies().empty());
  }
}

TEST_CASE("a concrete post of the editor bears what a hand calculation gives") {
  BuildingPlan plan;
  plan.post_width = 0.4;
  const structure::Building building = read(plan);
  const auto& capacity = building.joints.front().capacity.value;
  // 0.16 m2 of C25 with 16 cm2 of B500: 0.16 x 25 MN + 0.0016 x 500 MN = 4.8 MN; in tension the bars alone, 0.8 MN. In
  // bending half of them pull 0.4 MN; the block of concrete is 0.4 / (0.4 x 25) = 0.04 m deep, so the arm is 0.36 -
  // 0.02 m.
  CHECK(capacity[static_cast<std::size_t>(structure::Sense::compression)] == Approx(4.8e6));
  CHECK(capacity[static_cast<std::size_t>(structure::Sense::tension)] == Approx(0.8e6));
  CHECK(capacity[static_cast<std::size_t>(structure::Sense::moment_y)] == Approx(0.4e6 * 0.34));
}

TEST_CASE("the editor refuses what is out of bounds, with what is accepted") {
  BuildingPlan plan;
  plan.storeys = 61;
  try {
    (void)make_model_text(plan);
    FAIL("accepted");
  } catch (const structure::InputError& error) {
    CHECK(std::string(error.what()).find("storeys: found 61.0; accepted: 1.0 to 60.0") != std::string::npos);
  }
}

TEST_CASE("a click on a scene's picture chooses it") {
  std::optional<HeadlessContext> context;
  try {
    context.emplace();
  } catch (const std::runtime_error& error) {
    std::cout << "SKIPPED: " << error.what() << '\n';
    return;
  }
  const glm::ivec2 size(900, 600);
  Interface interface(1);
  StartPage page;
  std::optional<std::string> chosen;
  const auto frame = [&](glm::dvec2 at, bool pressed) {
    interface.point(at);
    interface.press(pressed);
    interface.begin_frame(size, 1.0 / 60);
    if (auto now = page.draw()) chosen = now;
    ImGui::EndFrame();
  };
  const glm::dvec2 first(60, 120);
  for (int i = 0; i < 3; ++i) frame(first, false);
  CHECK_FALSE(chosen);
  frame(first, true);
  frame(first, false);
  check_gl_errors();
  REQUIRE(chosen);
  CHECK(*chosen == opening_scene);
}
