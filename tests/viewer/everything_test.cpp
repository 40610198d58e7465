// A script that uses all that there is, panels included. Each picture checks OpenGL's errors; under the address
// sanitizer it finds leaks.
#include <stb_image.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "app/headless.h"
#include "renderer/headless_context.h"
#include "support/scratch_folder.h"

namespace {

using namespace topple::viewer;
namespace fs = std::filesystem;

bool can_draw() {
  try {
    const HeadlessContext context;
    return true;
  } catch (const std::runtime_error& error) {
    std::cout << "SKIPPED: " << error.what() << '\n';
    return false;
  }
}

/// Actions one after the other, a sixtieth of a second apart.
class Script {
 public:
  void add(const std::string& action) {
    text_ += (text_.empty() ? "" : ",\n") + ("{\"at\": " + std::to_string(at_) + ", " + action + "}");
    at_ += 1.0 / 60;
  }
  void click(int x, int y) { add("\"click\": [" + std::to_string(x) + ", " + std::to_string(y) + "]"); }
  void drag(int x, int y, int to_x, int to_y) {
    add("\"drag\": [[" + std::to_string(x) + ", " + std::to_string(y) + "], [" + std::to_string(to_x) + ", " +
        std::to_string(to_y) + "]]");
  }
  void write(const std::string& file) const {
    std::ofstream(file) << "{\"topple\": 1, \"actions\": [\n" << text_ << "]}";
  }

 private:
  std::string text_;
  double at_ = 0;
};

/// What the program writes beside pictures goes where the test stands.
struct StandIn {
  fs::path before = fs::current_path();
  explicit StandIn(const fs::path& folder) { fs::current_path(folder); }
  ~StandIn() { fs::current_path(before); }
};

constexpr int width = 430, height = 640;
constexpr int panel_left = width - 25 * 13;  // the panels' width in text sizes of 13 pixels

}  // namespace

TEST_CASE("a script that uses every view, tool, key and panel runs without an OpenGL error") {
  if (!can_draw()) return;
  const topple::test::ScratchFolder folder;
  const StandIn there(folder.path());
  Script script;
  for (const char* words : {"utilisation",     "axial",          "shear_y",
                            "shear_z",         "torsion",        "moment_y",
                            "moment_z",        "segments",       "path",
                            "plain",           "joints",         "diagram moment_y",
                            "diagram-scale 2", "no diagram",     "loads",
                            "reactions",       "contacts",       "arrow-scale 2",
                            "no loads",        "deflection 100", "vibration 1",
                            "mode-scale 2",    "buckling 1",     "no mode",
                            "largest",         "capacity",       "colour-blind safe",
                            "usual colours",   "no failed",      "failed",
                            "frame",           "panels"})
    script.add("\"show\": \"" + std::string(words) + "\"");
  script.add(R"("camera": {"eye": [-25, -25, 14], "target": [6, 8, 9]})");
  for (const char* tool : {"j", "m", "t", "k", "l", "v", "b", "g"}) {
    script.add("\"key\": \"" + std::string(tool) + "\"");
    script.click(50, 280);
  }
  script.add(R"("set": {"joints": "beams", "strength": 0.9})");
  script.add(R"("fire": {"pixel": [50, 300], "speed": 90, "mass": 2000, "radius": 0.6})");
  for (const char* key : {"c", "i", "o", "x", "1", "2", "3", "4", "1", "2", "3", "4", "n", "space", "f", "h", "u", "y"})
    script.add("\"key\": \"" + std::string(key) + "\"");
  // Every place of the panels, tab by tab, and the time line.
  for (int y = 12; y < height; y += 26) script.click(panel_left + 40, y);
  for (int y = 200; y < height; y += 40) script.drag(panel_left + 60, y, panel_left + 140, y);
  script.drag(20, height - 30, 80, height - 30);
  for (int x = 15; x < panel_left; x += 30) script.click(x, height - 52);
  script.add("\"key\": \"r\"");
  script.write("script.json");
  HeadlessOptions options;
  options.size = {width, height};
  options.panel = true;
  options.actions = "script.json";
  options.screenshot = "end.png";
  options.usd = "end.usda";
  REQUIRE_NOTHROW(run_headless(open_scene("seed_building"), options));
  int w = 0, h = 0, channels = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> pixels(stbi_load("end.png", &w, &h, &channels, 3),
                                                               stbi_image_free);
  REQUIRE(pixels);
  CHECK(w == width);
  CHECK(h == height);
  CHECK(fs::file_size("end.usda") > 1000);
}

TEST_CASE("panels are twice as large on a display of twice the density") {
  if (!can_draw()) return;
  const topple::test::ScratchFolder folder;
  HeadlessOptions options;
  options.panel = true;
  // Where the dark panel begins, in the first row.
  const auto panel_share = [&](int size, double scale) {
    options.size = {2 * size, size};
    options.scale = scale;
    options.screenshot = (folder / "panel.png").string();
    run_headless(open_scene("seed_building"), options);
    int w = 0, h = 0, channels = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> pixels(
        stbi_load(options.screenshot->c_str(), &w, &h, &channels, 3), stbi_image_free);
    REQUIRE(pixels);
    int x = w - 3;
    while (x > 0 && pixels.get()[3 * (2 * w + x)] < 90) --x;
    return static_cast<double>(w - x) / w;
  };
  const double usual = panel_share(400, 1), dense = panel_share(800, 2);
  CHECK(usual == Approx(25.0 * 13 / 800).epsilon(0.03));
  CHECK(dense == Approx(usual).epsilon(0.03));
}
