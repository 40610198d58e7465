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

/// What the command line asks for.
struct Request {
  std::string scene, size;
  bool headless = false, silent = false;
  topple::viewer::HeadlessOptions pictures;

  [[nodiscard]] bool has_output() const {
    return pictures.screenshot || pictures.record || pictures.actions || pictures.video || pictures.sound ||
           pictures.replay || pictures.usd || pictures.gltf || pictures.model || pictures.save;
  }
};

void add_options(CLI::App& app, Request& request) {
  namespace ranges = topple::structure::ranges;
  using topple::app::in_range;
  app.add_option(
      "scene", request.scene,
      "model or scenario: a shipped name or a file (in a window by default the start page, else town_house)");
  app.add_flag("--headless", request.headless, "draw without a window");
  app.add_option("--screenshot", request.pictures.screenshot, "file of the picture (in the window: what key P writes)");
  app.add_option("--at", request.pictures.at, "simulated seconds before the picture, and length of a recording")
      ->check(in_range(ranges::instant));
  app.add_option("--record", request.pictures.record, "folder for frame-00000.png and so on");
  app.add_option("--rate", request.pictures.rate, "recorded pictures for each simulated second")
      ->check(in_range(ranges::rate));
  app.add_option("--actions", request.pictures.actions, "script of what a person would do");
  app.add_option("--show", request.pictures.show,
                 "how to draw it, as the action `show` says; may be given several times");
  app.add_flag("--panel", request.pictures.panel, "with the panels, without a window");
  app.add_option("--scale", request.pictures.scale, "of the panels' text")->check(in_range({0.5, 4.0}));
  app.add_option("--video", request.pictures.video, "file of a video (.mp4, .webm); needs ffmpeg");
  app.add_option("--sound", request.pictures.sound, "file of what is heard at the eye (.wav)");
  app.add_flag("--no-sound", request.silent, "the window makes no sound");
  app.add_option("--replay", request.pictures.replay, "file of a page that shows the run again (.html)");
  app.add_option("--usd", request.pictures.usd, "file of the run as an animation (.usda)");
  app.add_option("--gltf", request.pictures.gltf, "file of the run as an animation (.glb)");
  app.add_option("--model", request.pictures.model, "file of the model as the run's actions have tuned it (.json)");
  app.add_option("--load", request.pictures.load, "saved run to take up (of this scene)");
  app.add_option("--save", request.pictures.save, "file that the run is saved to at its end");
  app.add_option("--size", request.size, "WIDTHxHEIGHT in pixels");
}

void open_window(const Request& request) {
  using namespace topple::viewer;
  std::optional<Scene> scene;
  if (!request.scene.empty()) {
    scene = open_scene(request.scene);
    remember_file(request.scene);
  }
  const HeadlessOptions& pictures = request.pictures;
  WindowOptions window;
  if (pictures.size) window.width = (*pictures.size)[0], window.height = (*pictures.size)[1];
  if (pictures.screenshot) window.screenshot = *pictures.screenshot;
  window.show = pictures.show;
  window.scale = pictures.scale;
  window.sound = !request.silent;
  run_window(std::move(scene), window);
}

int run(int argc, char** argv) {
  using namespace topple::app;
  CLI::App app{"Shows a building under its loads and lets you demolish it.", "topple-viewer"};
  app.set_version_flag("--version", version());
  Request request;
  add_options(app, request);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return print_error("topple-viewer", error.what(), bad_input);
  }
  if (!request.size.empty()) request.pictures.size = parse_size(request.size);
  if (!request.headless) {
    open_window(request);
    return 0;
  }
  if (!request.has_output())
    throw topple::structure::InputError(
        "--headless needs --screenshot, --record, --actions, --video, --sound, --replay, --usd, --gltf, --model or "
        "--save");
  using namespace topple::viewer;
  run_headless(open_scene(request.scene.empty() ? opening_scene : request.scene), request.pictures);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  topple::solver::prepare_blas(argv);
  return topple::app::run_program("topple-viewer", [&] { return run(argc, argv); });
}
