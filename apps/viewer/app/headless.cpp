#include "app/headless.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/actions.h"
#include "app/controller.h"
#include "app/interface.h"
#include "app/output/gltf_scene.h"
#include "app/output/html_replay.h"
#include "app/output/outputs.h"
#include "app/output/usd_scene.h"
#include "app/side_panel.h"
#include "app/sound/speaker.h"
#include "app/sound/synthesis.h"
#include "renderer/frame_composer.h"
#include "renderer/gl_errors.h"
#include "renderer/headless_context.h"
#include "renderer/picture_renderer.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::viewer {
namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

/// What a window has, without one.
class Stage {
 public:
  Stage(const Scene& scene, glm::ivec2 size, bool panel, double scale)
      : size_(size),
        instances_(*scene.building, ground_height(*scene.building, scene.scenario)),
        renderer_(instances_, ground_height(*scene.building, scene.scenario)) {
    if (!panel) return;
    interface_.emplace(static_cast<float>(scale));
    composer_.emplace(size);
  }
  [[nodiscard]] glm::dvec2 scene_size() const {
    return interface_ ? glm::dvec2(glm::ivec2(SidePanel::scene_size(size_))) : glm::dvec2(size_);
  }
  [[nodiscard]] Image draw(Controller& controller) {
    outputs_.before_picture(controller);
    const Snapshot moment = controller.shown(true);
    instances_.update(moment, controller.options);
    renderer_.draw(instances_, controller.camera, controller.options, glm::ivec2(scene_size()));
    outputs_.after_picture(controller, renderer_);
    controller.window.picture_graphics = renderer_.graphics_milliseconds();
    if (interface_) draw_interface(controller, moment);
    Image image = interface_ ? composer_->read() : renderer_.read();
    check_gl_errors();
    return image;
  }
  /// True when the panels take what the pointer does there.
  bool panel_at(glm::dvec2 pixel) const {
    return interface_ && (pixel.x >= scene_size().x || pixel.y >= scene_size().y);
  }
  /// Where the pointer stays: what is told of a part is written there.
  void point(glm::dvec2 pixel) {
    if (interface_) interface_->point(pixel);
  }
  /// Presses at one place, moves to the other, and lets go: frames as a window would draw them in between.
  void drag_in_panel(Controller& controller, glm::dvec2 from, glm::dvec2 to) {
    constexpr int ways = 4;
    frame(controller, from, false);
    frame(controller, from, false);
    for (int i = 0; i <= ways; ++i) frame(controller, from + (to - from) * (static_cast<double>(i) / ways), true);
    frame(controller, to, false);
    frame(controller, {-1, -1}, false);
    // What the panel was asked for is done when the next action comes.
    do (void)draw(controller);
    while (outputs_.busy());
    controller.files().finish_export();
  }

 private:
  /// The panels alone: the scene behind them stays as it was drawn last.
  void frame(Controller& controller, glm::dvec2 pointer, bool pressed) {
    interface_->point(pointer);
    interface_->press(pressed);
    controller.update(0);
    const Snapshot moment = controller.shown(true);
    instances_.update(moment, controller.options);
    if (!laid_out_) (void)draw(controller);
    draw_interface(controller, moment);
  }
  void draw_interface(Controller& controller, const Snapshot& moment) {
    composer_->begin(renderer_);
    // The first frame only finds out how large everything is.
    for (int i = laid_out_ ? 1 : 0; i < 2; ++i) {
      lay_out(controller, moment);
      Interface::end_frame();
    }
    laid_out_ = true;
  }
  void lay_out(Controller& controller, const Snapshot& moment) {
    interface_->begin_frame(size_, 1.0 / 60);
    panel_.draw(controller, moment, instances_, "");
    if (!controller.window.photo) draw_hover_text(controller, moment);
  }

  glm::ivec2 size_;
  HeadlessContext context_;
  SceneInstances instances_;
  Renderer renderer_;
  std::optional<Interface> interface_;
  std::optional<FrameComposer> composer_;
  SidePanel panel_;
  Outputs outputs_;
  bool laid_out_ = false;
};

class HeadlessRun {
 public:
  HeadlessRun(const Scene& scene, Script script, std::array<int, 2> size, const HeadlessOptions& options)
      : session_(scene.building, scene.scenario, scene.drawn, std::make_shared<Recording>(),
                 structure::StateStore::of_user()),
        driver_(session_),
        stage_(scene, {size[0], size[1]}, options.panel, options.scale),
        controller_(driver_, scene, ground_height(*scene.building, scene.scenario), stage_.scene_size()),
        script_(std::move(script)) {
    if (options.load) {
      controller_.files().load(*options.load);
      frames_ = session_.simulation().steps();
      heard_ = std::llround(clock() * sample_rate);
    }
    for (const std::string& words : options.show) controller_.show(words);
    controller_.update(0);
    if (options.sound) speaker_ = Speaker::into_memory();
  }

  /// Up to the given time, doing what the script says on the way. False: the script has quit.
  bool run_until(double time) {
    while (act() && clock() + 0.5 * session_.scenario().step < time) {
      driver_.advance();
      controller_.update(session_.scenario().step);
      ++frames_;
      if (speaker_) listen();
    }
    return !quit_;
  }
  [[nodiscard]] double last_action() const { return script_.actions.empty() ? 0 : script_.actions.back().at; }
  [[nodiscard]] Image draw() {
    controller_.update(0);
    return stage_.draw(controller_);
  }
  void write(const std::string& file) {
    write_png(draw(), file);
    std::printf("%s at %.3f s\n", structure::one_line(file).c_str(), driver_.moment().later->time);
  }
  void save(const std::string& file) { controller_.files().save(file); }
  void write_sound(const std::string& file) const { write_wav(file, sound_); }
  [[nodiscard]] const Recording& recording() const { return driver_.recording(); }
  [[nodiscard]] const Snapshot& present() { return *(now_ = driver_.moment().later); }

 private:
  /// What is heard up to now, in whole samples.
  void listen() {
    speaker_->hear(driver_.moment().interpolated(), controller_.camera, 1);
    const auto until = static_cast<std::int64_t>(std::llround(clock() * sample_rate));
    const std::vector<float> next = speaker_->render(static_cast<int>(until - heard_));
    heard_ = until;
    sound_.insert(sound_.end(), next.begin(), next.end());
  }
  [[nodiscard]] double clock() const { return static_cast<double>(frames_) * session_.scenario().step; }

  bool act() {
    while (!quit_ && next_ < script_.actions.size() &&
           script_.actions[next_].at <= clock() + 1e-6 * session_.scenario().step)
      perform(script_.actions[next_++]);
    return !quit_;
  }

  void click(glm::dvec2 pixel) {
    if (stage_.panel_at(pixel)) return stage_.drag_in_panel(controller_, pixel, pixel);
    controller_.hover(pixel);
    stage_.point(pixel);
    controller_.click(pixel);
  }
  void drag(const DragAction& a) {
    stage_.panel_at(a.from) ? stage_.drag_in_panel(controller_, a.from, a.to) : controller_.drag(a.from, a.to);
  }

  void perform(const Action& action) {
    std::visit(Overloaded{[&](const CameraAction& a) { controller_.glide(a.camera, a.over); },
                          [&](const ClickAction& a) { click(a.pixel); },
                          [&](const FireAction& a) {
                            controller_.hand.shot = a.shot;
                            controller_.fire(a.pixel);
                          },
                          [&](const KeyAction& a) {
                            if (controller_.key(a.key)) return;
                            std::string accepted;
                            for (const std::string& name : Controller::key_names())
                              accepted += (accepted.empty() ? "" : ", ") + name;
                            throw structure::InputError("no such key: '" + a.key + "'; accepted: " + accepted);
                          },
                          [&](const DragAction& a) { drag(a); },
                          [&](const structure::JointChange& a) { controller_.tune(a); },
                          [&](const ShowAction& a) { controller_.show(a.what); },
                          [&](const PanAction& a) { controller_.drag_to_pan(a.from, a.to); },
                          [&](const ZoomAction& a) { controller_.scroll(a.clicks); },
                          [&](const FlyAction& a) { controller_.camera.fly(a.way.x, a.way.y, a.way.z); },
                          [&](const SelectAction& a) { controller_.select(a.name); },
                          [&](const ToolAction& a) { pick_up(a, controller_.hand); },
                          [&](const GravityAction& a) { controller_.set_gravity(a.downwards); },
                          [&](const ShakeAction& a) {
                            controller_.hand.shaking = a.shake;
                            controller_.shake();
                          },
                          [&](const LookAction& a) {
                            if (a.time && *a.time < driver_.recording().span()[0]) controller_.playback().record_past();
                            a.time ? controller_.playback().seek(*a.time) : controller_.playback().seek_present();
                          },
                          [&](const GoOnAction&) { controller_.playback().go_on_from_here(); },
                          [&](const RestartAction& a) { controller_.restart(rules_of(a, controller_.scene())); },
                          [&](const SaveAction& a) { controller_.files().save(a.file); },
                          [&](const LoadAction& a) { controller_.files().load(a.file); },
                          [&](const ExportAction& a) {
                            controller_.files().export_run(a.file);
                            controller_.files().finish_export();
                          },
                          [&](const ScreenshotAction& a) { write(a.file); },
                          [&](const QuitAction&) { quit_ = true; }},
               action.what);
    controller_.update(0);
  }

  Session session_;
  DirectDriver driver_;
  Stage stage_;
  Controller controller_;
  Script script_;
  std::shared_ptr<const Snapshot> now_;
  std::unique_ptr<Speaker> speaker_;
  std::vector<float> sound_;  ///< left and right in turn
  std::int64_t heard_ = 0;    ///< samples
  std::size_t next_ = 0;
  std::int64_t frames_ = 0;  ///< steps and pauses
  bool quit_ = false;
};

/// Pictures at even times, into a folder, a video, or both; returns how many.
int record(HeadlessRun& run, const HeadlessOptions& options, double until) {
  std::vector<PictureSequence> sequences;
  sequences.reserve(2);
  if (options.record) sequences.emplace_back(*options.record, options.rate, PictureSequence::Kind::folder);
  if (options.video) sequences.emplace_back(*options.video, options.rate, PictureSequence::Kind::video);
  const auto count = static_cast<int>(std::floor(until * options.rate + 1e-6)) + 1;
  for (int i = 0; i < count; ++i) {
    if (!run.run_until(i / options.rate)) break;
    const Image image = run.draw();
    for (PictureSequence& sequence : sequences) sequence.add(image);
  }
  for (PictureSequence& sequence : sequences) {
    sequence.finish();
    std::printf("%s: %d pictures\n", structure::one_line(sequence.target()).c_str(), sequence.count());
  }
  return sequences.front().count();
}

/// Pictures of an earlier, longer recording would look as if they were this one's.
void remove_earlier(const structure::OutputFolder& folder, int pictures) {
  std::vector<std::string> kept;
  for (int i = 0; i < pictures; ++i) kept.push_back(PictureSequence::picture_name(i));
  folder.remove_numbered("frame-", ".png", kept);
}

/// What cannot be written is told before the work.
void try_outputs(const Scene& scene, const HeadlessOptions& options, const Script& script) {
  std::vector<std::string> outputs;
  for (const auto& file : {options.screenshot, options.video, options.sound, options.replay, options.usd, options.gltf,
                           options.model, options.save})
    if (file) outputs.push_back(*file);
  for (const Action& action : script.actions) {
    if (const auto* saved = std::get_if<SaveAction>(&action.what)) outputs.push_back(saved->file);
    if (const auto* written = std::get_if<ExportAction>(&action.what)) outputs.push_back(written->file);
    if (const auto* picture = std::get_if<ScreenshotAction>(&action.what)) outputs.push_back(picture->file);
  }
  for (const std::string& output : outputs) {
    structure::require_writable(output);
    structure::require_different(scene.model, output);
    if (options.actions) structure::require_different(*options.actions, output);
  }
}

void require_number_of_pictures(double seconds, double rate) {
  constexpr double most = 1e6;
  if (!(seconds * rate < most))
    throw structure::InputError("--rate, --at: more than a million pictures; accepted: fewer");
}

/// A run that is looked at has no end: what comes after the scenario's is not the scenario's, and that is said.
void warn_past_end(const Scene& scene, double at) {
  if (!scene.lasts || at <= *scene.lasts) return;
  std::fprintf(stderr,
               "topple-viewer: --at %g: the scenario ends at %g s (its \"duration\"), and the run goes on without it; "
               "accepted without this line: 0 to %g\n",
               at, *scene.lasts, *scene.lasts);
}

}  // namespace

void run_headless(const Scene& scene, const HeadlessOptions& options) {
  Script script = options.actions ? read_script(*options.actions) : Script();
  const std::array<int, 2> size = options.size ? *options.size : script.size.value_or(std::array<int, 2>{1280, 720});
  try_outputs(scene, options, script);
  warn_past_end(scene, options.at);
  std::optional<structure::OutputFolder> pictures;
  if (options.record)
    pictures.emplace(*options.record, std::vector<std::filesystem::path>{scene.model},
                     std::vector<std::string>{"frame-*.png"});
  HeadlessRun run(scene, std::move(script), size, options);
  const double end = std::max(options.at, run.last_action());
  if (options.record || options.video) require_number_of_pictures(end, options.rate);
  if (options.record || options.video) {
    const int count = record(run, options, end);
    if (pictures) remove_earlier(*pictures, count);
  }
  run.run_until(end);
  if (options.screenshot) run.write(*options.screenshot);
  if (options.sound) run.write_sound(*options.sound);
  if (options.replay) write_html_replay(*scene.building, run.recording(), *options.replay);
  if (options.usd) write_usd(*scene.building, run.recording(), *options.usd);
  if (options.gltf) write_gltf(*scene.building, run.recording(), *options.gltf);
  if (options.save) run.save(*options.save);
  if (options.model) write_tuned_model(scene, run.present(), *options.model);
}

}  // namespace topple::viewer
