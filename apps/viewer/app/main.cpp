// topple-viewer: a window on a building that stands, is examined, and is demolished; or pictures of it without a
// window. Exit status: 0 done, 1 failure, 2 bad input, 3 the model is not stable.
#include <cstdio>

#include "app/headless.h"
#include "app/start/recent_files.h"
#include "app/start/shipped_scenes.h"
#include "app/window.h"
#include "support/command_line.h"
#include "support/version.h"
#include "topple/solver/blas_kernel.h"
#include "topple/structure/error.h"

#ifdef __SANITIZE_ADDRESS__
// What a graphics driver leaks is told with its name, and so can be told from what we leak, only while it is loaded.
extern "C" int dlclose(void*) noexcept { return 0; }
#endif

namespace {

/// "1280x720"
std::array<int, 2> parse_size(const std::string& text) {
  std::array<int, 2> size{};
  char after = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", size.data(), size.data() + 1, &after) != 2 || size[0] < 16 || size[1] < 16 ||
      size[0] > 16384 || size[1] > 16384)
    throw topple::structure::InputError("--size " + text + ": accepted: WIDTHxHEIGHT, each from 16 to 16384");
  return size;
}

int run(int argc, char** argv) {
  using namespace topple::viewer;
  using namespace topple::app;
  namespace ranges = topple::structure::ranges;
  CLI::App app{"Shows a building under its loads and lets you demolish it.", "topple-viewer"};
  app.set_version_flag("--version", version());
  std::string name, size;
  bool headless = false, silent = false;
  HeadlessOptions pictures;
  app.add_option(
      "scene", name,
      "model or scenario: a shipped name or a file (in a window by default the start page, else town_house)");
  app.add_flag("--headless", headless, "draw without a window");
  app.add_option("--screenshot", pictures.screenshot, "file of the picture (in the window: what key P writes)");
  app.add_option("--at", pictures.at, "simulated seconds before the picture, and length of a recording")
      ->check(in_range(ranges::instant));
  app.add_option("--record", pictures.record, "folder for frame-00000.png and so on");
  app.add_option("--rate", pictures.rate, "recorded pictures for each simulated second")->check(in_range(ranges::rate));
  app.add_option("--actions", pictures.actions, "script of what a person would do");
  app.add_option("--show", pictures.show, "how to draw it, as the action `show` says; may be given several times");
  app.add_flag("--panel", pictures.panel, "with the panels, without a window");
  app.add_option("--scale", pictures.scale, "of the panels' text")->check(in_range({0.5, 4.0}));
  app.add_option("--video", pictures.video, "file of a video (.mp4, .webm); needs ffmpeg");
  app.add_option("--sound", pictures.sound, "file of what is heard at the eye (.wav)");
  app.add_flag("--no-sound", silent, "the window makes no sound");
  app.add_option("--replay", pictures.replay, "file of a page that shows the run again (.html)");
  app.add_option("--usd", pictures.usd, "file of the run as an animation (.usda)");
  app.add_option("--gltf", pictures.gltf, "file of the run as an animation (.glb)");
  app.add_option("--model", pictures.model, "file of the model as the run's actions have tuned it (.json)");
  app.add_option("--load", pictures.load, "saved run to take up (of this scene)");
  app.add_option("--save", pictures.save, "file that the run is saved to at its end");
  app.add_option("--size", size, "WIDTHxHEIGHT in pixels");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return tell_error("topple-viewer", error.what(), bad_input);
  }
  if (!size.empty()) pictures.size = parse_size(size);
  const bool output = pictures.screenshot || pictures.record || pictures.actions || pictures.video || pictures.sound ||
                      pictures.replay || pictures.usd || pictures.gltf || pictures.model || pictures.save;
  if (headless && !output)
    throw topple::structure::InputError(
        "--headless needs --screenshot, --record, --actions, --video, --sound, --replay, --usd, --gltf, --model or "
        "--save");
  if (headless) {
    run_headless(open_scene(name.empty() ? opening_scene : name), pictures);
    return 0;
  }
  std::optional<Scene> scene;
  if (!name.empty()) {
    scene = open_scene(name);
    remember_file(name);
  }
  WindowOptions window;
  if (pictures.size) window.width = (*pictures.size)[0], window.height = (*pictures.size)[1];
  if (pictures.screenshot) window.screenshot = *pictures.screenshot;
  window.show = pictures.show;
  window.scale = pictures.scale;
  window.sound = !silent;
  run_window(std::move(scene), window);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  topple::solver::prepare_blas(argv);
  return topple::app::run_program("topple-viewer", [&] { return run(argc, argv); });
}
