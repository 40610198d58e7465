// The viewer as a person or a script uses it.
#include <stb_image.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <vector>

#include "app/actions.h"
#include "app/headless.h"
#include "app/session.h"
#include "renderer/headless_context.h"
#include "support/scratch_folder.h"
#include "support/source_tree.h"
#include "topple/structure/error.h"

namespace {

using namespace topple::viewer;
namespace fs = std::filesystem;

struct Folder : topple::test::ScratchFolder {
  [[nodiscard]] std::string file(const std::string& name) const { return (*this / name).string(); }
};

struct Picture {
  int width = 0, height = 0;
  std::unique_ptr<unsigned char, void (*)(void*)> pixels{nullptr, stbi_image_free};
  explicit Picture(const std::string& file) {
    int channels = 0;
    pixels.reset(stbi_load(file.c_str(), &width, &height, &channels, 3));
    REQUIRE(pixels);
  }
  [[nodiscard]] int at(int i, int channel) const { return pixels.get()[3 * i + channel]; }
  /// Share of pixels in the blue of failed joints.
  [[nodiscard]] double failed() const {
    int count = 0;
    for (int i = 0; i < width * height; ++i)
      count += at(i, 2) > 110 && at(i, 2) > 2 * at(i, 0) && at(i, 2) > at(i, 1) + 40 ? 1 : 0;
    return static_cast<double>(count) / (width * height);
  }
  /// Pixels in the colour of what is selected.
  [[nodiscard]] int orange() const {
    int count = 0;
    for (int i = 0; i < width * height; ++i)
      count += at(i, 0) > 150 && at(i, 0) > at(i, 1) + 45 && at(i, 1) > at(i, 2) + 25 ? 1 : 0;
    return count;
  }
  [[nodiscard]] double changed(const Picture& other) const {
    REQUIRE(width == other.width);
    REQUIRE(height == other.height);
    int count = 0;
    for (int i = 0; i < width * height; ++i) {
      int difference = 0;
      for (int c = 0; c < 3; ++c) difference += std::abs(at(i, c) - other.at(i, c));
      count += difference > 24 ? 1 : 0;
    }
    return static_cast<double>(count) / (width * height);
  }
};

bool can_draw() {
  try {
    const HeadlessContext context;
    return true;
  } catch (const std::runtime_error& error) {
    std::cout << "SKIPPED: " << error.what() << '\n';
    return false;
  }
}

std::string refused(const std::string& text) {
  const Folder folder;
  std::ofstream(folder.file("script.json")) << text;
  try {
    (void)read_script(folder.file("script.json"));
  } catch (const topple::structure::InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("without a window, the hit building shows failed joints that the standing one has not") {
  if (!can_draw()) return;
  const Folder folder;
  const Scene scene = open_scene("seed_hit");
  HeadlessOptions options;
  options.size = {320, 180};
  options.show = {"joints", "no dust"};  // it would hide some
  options.screenshot = folder.file("before.png");
  options.at = 0.5;  // the shot comes at 1 s
  run_headless(scene, options);
  options.screenshot = folder.file("after.png");
  options.at = 9;  // well into the collapse
  run_headless(scene, options);
  const Picture before(folder.file("before.png")), after(folder.file("after.png"));
  CHECK(before.width == 320);
  CHECK(before.height == 180);
  CHECK(before.failed() == 0);
  CHECK(after.failed() > 0.001);
}

TEST_CASE("demolish draws pictures at even times, from the building that stands to the one that was hit") {
  if (!can_draw()) return;
  const Folder folder;
  std::ofstream(folder.file("hit.json")) << R"({"topple": 1, "model": "seed_building", "combination": "collapse",
      "duration": 2.5, "events": [{"at": 0.2, "projectile":
      {"from": [-20, 0, 2], "velocity": [60, 0, 0], "mass": 500, "radius": 0.4}}]})";
  const std::string command = std::string(TOPPLE_PROGRAM) + " demolish " + folder.file("hit.json") + " -o " +
                              folder.file("out") + " --images --rate 2 >" + folder.file("log") + " 2>&1";
  REQUIRE(std::system(command.c_str()) == 0);
  std::vector<Picture> pictures;
  for (int i = 0; i <= 5; ++i) {
    CAPTURE(i);
    pictures.emplace_back(folder.file("out/frame-0000" + std::to_string(i) + ".png"));
    CHECK(pictures.back().width > 0);
  }
  CHECK(pictures[5].changed(pictures[0]) > 0.005);
  CHECK_FALSE(std::filesystem::exists(folder.file("out/frame-00006.png")));
}

TEST_CASE("a script sets the camera, fires, pauses and takes pictures at its times") {
  if (!can_draw()) return;
  const Folder folder;
  std::ofstream(folder.file("script.json")) << R"({"topple": 1, "size": [240, 160], "actions": [
        {"at": 0, "camera": {"eye": [-30, -25, 12], "target": [8, 8, 8], "field_of_view": 0.8}},
        {"at": 0, "show": "joints"},
        {"at": 0, "screenshot": ")" << folder.file("standing.png")
                                            << R"("},
        {"at": 0.1, "fire": {"pixel": [100, 100], "speed": 120, "mass": 3000, "radius": 0.6}},
        {"at": 1.5, "screenshot": ")" << folder.file("hit.png")
                                            << R"("},
        {"at": 1.5, "key": "space"},
        {"at": 2.0, "screenshot": ")" << folder.file("paused.png")
                                            << R"("},
        {"at": 2.0, "drag": [[100, 80], [160, 80]]},
        {"at": 2.0, "screenshot": ")" << folder.file("dragged.png")
                                            << R"("},
        {"at": 2.1, "quit": true}]})";
  HeadlessOptions options;
  options.actions = folder.file("script.json");
  run_headless(open_scene("seed_building"), options);
  const Picture standing(folder.file("standing.png")), hit(folder.file("hit.png")), paused(folder.file("paused.png")),
      dragged(folder.file("dragged.png"));
  CHECK(standing.width == 240);
  CHECK(standing.failed() == 0);
  CHECK(hit.failed() > 0);
  CHECK(paused.changed(hit) == 0);
  CHECK(dragged.changed(paused) > 0.1);
}

TEST_CASE("undo returns to the very state before the last action") {
  const Scene scene = open_scene("seed_building");
  Session session(scene.building, scene.scenario);
  topple::structure::Projectile shot;
  shot.from = {-20, 0, 2};
  shot.velocity = {60, 0, 0};
  for (int i = 0; i < 5; ++i) session.step();
  session.apply(shot);
  for (int i = 0; i < 40; ++i) session.step();
  const std::uint64_t before = session.simulation().hash();
  shot.from.z() += 3;
  session.apply(shot);
  for (int i = 0; i < 40; ++i) session.step();
  CHECK(session.simulation().hash() != before);
  REQUIRE(session.undo());
  CHECK(session.simulation().steps() == 45);
  CHECK(session.simulation().hash() == before);
  CHECK(session.undo());
  CHECK_FALSE(session.undo());
  CHECK(session.simulation().steps() == 5);
}

TEST_CASE("a script's mistakes are named with their place") {
  CHECK(refused(R"({"topple": 1, "actions": [{"at": 0, "jump": 1}]})").find("actions[0]: unknown key 'jump'") !=
        std::string::npos);
  CHECK(refused(R"({"topple": 1, "actions": [{"at": 0, "click": [1]}]})").find("actions[0].click") !=
        std::string::npos);
  CHECK(refused(R"({"topple": 1, "actions": [{"click": [1, 2]}]})").find("'at' is missing") != std::string::npos);
  CHECK(refused(R"({"topple": 1, "actions": [{"at": 0, "key": "n", "zoom": 1}]})").find("accepted: camera, click") !=
        std::string::npos);
  CHECK(refused(R"({"topple": 1, "actions": [{"at": 0, "tool": {"name": "saw"}}]})")
            .find("accepted: fire, wrecking ball") != std::string::npos);
  CHECK(refused(R"({"topple": 1, "actions": [{"at": 0, "restart": {"bracing": "some"}}]})")
            .find("accepted: buckling, classic, none") != std::string::npos);
  CHECK(
      refused(R"({"topple": 1, "actions": [{"at": 0, "restart": {"generations_per_second": 240}}]})")
          .find("restart.generations_per_second: nothing limits what may break in a step any more: a step computes all "
                "that happens in it, and the pace of the steps is the host's") != std::string::npos);
  CHECK(refused(R"({"topple": 1, "actions": [{"at": 0, "look_at": "past"}]})").find("accepted: present") !=
        std::string::npos);
  CHECK(refused(R"({"topple": 2, "actions": []})").find("format 1") != std::string::npos);
  CHECK(refused(R"({"topple": 1, "actions": [)").find("not JSON") != std::string::npos);
  CHECK(refused(R"({"topple": 1, "actions": [{"at": 0, "quit": true}]})").empty());
}

TEST_CASE("in a window, a person orbits, fires, sees joints fail, and pauses") {
  const Folder folder;
  const std::string command = topple::test::in_source_tree("tests/viewer/drive_window.sh '") +
                              TOPPLE_VIEWER_PROGRAM "' '" + folder.path().string() + "'";
  const int status = WEXITSTATUS(std::system(command.c_str()));
  if (status == 77) {
    std::cout << "SKIPPED: Xvfb or xdotool is not installed\n";
    return;
  }
  REQUIRE(status == 0);
  const Picture start(folder.file("start.png")), orbited(folder.file("orbited.png")), picked(folder.file("picked.png")),
      hit(folder.file("hit.png")), scrubbed(folder.file("scrubbed.png")), paused1(folder.file("paused1.png")),
      paused2(folder.file("paused2.png"));
  CHECK(start.failed() == 0);
  CHECK(orbited.changed(start) > 0.1);
  CHECK(picked.orange() > orbited.orange());
  CHECK(hit.failed() > 0);
  CHECK(scrubbed.failed() == 0);
  CHECK(paused2.changed(paused1) == 0);
}

TEST_CASE("a picture after the scenario's end is drawn, and one line says that the run went on without it") {
  if (!can_draw()) return;
  const Folder folder;
  std::ofstream(folder.file("short.json")) << R"({"topple": 1, "model": "wall", "duration": 0.2, "events": []})";
  const auto said_for = [&](const std::string& scene, const std::string& at) {
    fs::remove(folder.file("picture.png"));
    const std::string command = "'" TOPPLE_VIEWER_PROGRAM "' '" + scene + "' --headless --size 64x48 --at " + at +
                                " --screenshot '" + folder.file("picture.png") + "' 2> '" + folder.file("said") + "'";
    REQUIRE(std::system(command.c_str()) == 0);
    CHECK(fs::exists(folder.file("picture.png")));
    std::ifstream said(folder.file("said"));
    return std::string(std::istreambuf_iterator<char>(said), {});
  };
  CHECK(said_for(folder.file("short.json"), "0.3") ==
        "topple-viewer: --at 0.3: the scenario ends at 0.2 s (its \"duration\"), and the run goes on without it; "
        "accepted without this line: 0 to 0.2\n");
  CHECK(said_for(folder.file("short.json"), "0.2").empty());
  CHECK(said_for("wall", "0.3").empty());  // a model has no end
}

TEST_CASE("without a display the viewer says in one line why it opens no window") {
  const Folder folder;
  const std::string command =
      "env -u DISPLAY -u WAYLAND_DISPLAY '" TOPPLE_VIEWER_PROGRAM "' 2> '" + folder.file("said") + "'";
  CHECK(WEXITSTATUS(std::system(command.c_str())) == 1);
  std::ifstream said(folder.file("said"));
  std::string line, more;
  std::getline(said, line);
  CHECK(line.find("no window can be opened") != std::string::npos);
  CHECK_FALSE(std::getline(said, more));
}
