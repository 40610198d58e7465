#include "app/headless.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/actions.h"
#include "renderer/picture_renderer.h"
#include "topple/structure/error.h"

namespace topple::viewer {
namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

class HeadlessRun {
 public:
  HeadlessRun(const Scene& scene, Script script, std::array<int, 2> size)
      : session_(scene.building, scene.scenario),
        driver_(session_),
        ground_(ground_height(*scene.building, scene.scenario)),
        renderer_(*scene.building, ground_, size[0], size[1]),
        controller_(driver_, scene, ground_, {size[0], size[1]}),
        script_(std::move(script)) {}

  /// Up to the given time, doing what the script says on the way. False: the script has quit.
  bool run_until(double time) {
    while (act() && clock() + 0.5 * session_.scenario().step < time) {
      driver_.advance();
      ++frames_;
    }
    return !quit_;
  }
  [[nodiscard]] double last_action() const { return script_.actions.empty() ? 0 : script_.actions.back().at; }

  void write(const std::string& file) {
    controller_.update();
    const Snapshot snapshot = controller_.drawn(driver_.moment().interpolated(), clock(), true);
    renderer_.write(snapshot, controller_.camera, controller_.options, file);
    std::printf("%s at %.3f s\n", file.c_str(), snapshot.time);
  }

 private:
  [[nodiscard]] double clock() const { return static_cast<double>(frames_) * session_.scenario().step; }

  bool act() {
    while (!quit_ && next_ < script_.actions.size() &&
           script_.actions[next_].at <= clock() + 1e-6 * session_.scenario().step)
      perform(script_.actions[next_++]);
    return !quit_;
  }

  void perform(const Action& action) {
    std::visit(Overloaded{[&](const CameraAction& a) { controller_.camera = a.camera; },
                          [&](const ClickAction& a) { controller_.fire(a.pixel); },
                          [&](const FireAction& a) {
                            controller_.shot = a.shot;
                            controller_.fire(a.pixel);
                          },
                          [&](const KeyAction& a) {
                            if (!controller_.key(a.key)) throw structure::InputError("no such key: '" + a.key + "'");
                          },
                          [&](const DragAction& a) { controller_.drag(a.from, a.to); },
                          [&](const ShowAction& a) { controller_.show(a.what); },
                          [&](const ScreenshotAction& a) { write(a.file); }, [&](const QuitAction&) { quit_ = true; }},
               action.what);
  }

  Session session_;
  DirectDriver driver_;
  double ground_;
  PictureRenderer renderer_;
  Controller controller_;
  Script script_;
  std::size_t next_ = 0;
  std::int64_t frames_ = 0;  ///< steps and pauses
  bool quit_ = false;
};

void record(HeadlessRun& run, const std::string& folder, double until, double rate) {
  std::filesystem::create_directories(folder);
  const auto count = static_cast<int>(std::floor(until * rate + 1e-6)) + 1;
  for (int i = 0; i < count; ++i) {
    if (!run.run_until(i / rate)) return;
    char name[32];
    std::snprintf(name, sizeof name, "frame-%05d.png", i);
    run.write((std::filesystem::path(folder) / name).string());
  }
}

}  // namespace

void run_headless(const Scene& scene, const HeadlessOptions& options) {
  Script script = options.actions ? read_script(*options.actions) : Script();
  const std::array<int, 2> size = options.size ? *options.size : script.size.value_or(std::array<int, 2>{1280, 720});
  HeadlessRun run(scene, std::move(script), size);
  const double end = std::max(options.at, run.last_action());
  if (options.record) record(run, *options.record, end, options.rate);
  run.run_until(end);
  if (options.screenshot) run.write(*options.screenshot);
}

}  // namespace topple::viewer
