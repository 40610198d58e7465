#include "app/window.h"

#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <cmath>
#include <ctime>
#include <future>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>

#include "app/driver.h"
#include "app/interface.h"
#include "app/output/outputs.h"
#include "app/side_panel.h"
#include "app/sound/speaker.h"
#include "app/start/recent_files.h"
#include "app/start/start_page.h"
#include "renderer/frame_composer.h"
#include "renderer/gl_errors.h"
#include "renderer/picture_renderer.h"
#include "topple/structure/error.h"

namespace topple::viewer {
namespace {

std::string& last_glfw_error() {
  static std::string text;
  return text;
}

[[noreturn]] void refuse() {
  const std::string why = last_glfw_error().empty() ? "unknown reason" : last_glfw_error();
  throw std::runtime_error("no window can be opened: " + why + "; --headless draws without one");
}

/// The window with its OpenGL context, current while it lives.
class Window {
 public:
  Window(int width, int height, const std::string& title) {
    glfwSetErrorCallback([](int, const char* text) { last_glfw_error() = text; });
    if (glfwInit() != GLFW_TRUE) refuse();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
      glfwTerminate();
      refuse();
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
  }
  ~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
  }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  [[nodiscard]] GLFWwindow* get() const { return window_; }
  [[nodiscard]] glm::dvec2 size() const {
    int w = 0, h = 0;
    glfwGetWindowSize(window_, &w, &h);
    return {std::max(w, 1), std::max(h, 1)};
  }
  [[nodiscard]] glm::ivec2 pixels() const {
    int w = 0, h = 0;
    glfwGetFramebufferSize(window_, &w, &h);
    return {std::max(w, 1), std::max(h, 1)};
  }

 private:
  GLFWwindow* window_ = nullptr;
};

float content_scale(GLFWwindow* window) {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window, &x, &y);
  // Where a window's units are larger than pixels, text is scaled with them already.
  int units = 0, pixels = 0, unused = 0;
  glfwGetWindowSize(window, &units, &unused);
  glfwGetFramebufferSize(window, &pixels, &unused);
  return units > 0 ? std::max(1.0F, x * static_cast<float>(units) / static_cast<float>(std::max(pixels, 1))) : x;
}

/// Dear ImGui fed by the window. GLFW's callbacks of our own are set before.
class WindowInterface {
 public:
  WindowInterface(GLFWwindow* window, double scale)
      : window_(window),
        wanted_(static_cast<float>(scale)),
        interface_(content_scale(window) * static_cast<float>(scale)) {
    ImGui_ImplGlfw_InitForOpenGL(window, true);
  }
  ~WindowInterface() { ImGui_ImplGlfw_Shutdown(); }
  WindowInterface(const WindowInterface&) = delete;
  WindowInterface& operator=(const WindowInterface&) = delete;
  /// The window may have been moved to a screen of another scale: what is laid out from here on is as large there.
  void follow_scale() { interface_.set_scale(content_scale(window_) * wanted_); }
  static void begin_frame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
  }

 private:
  GLFWwindow* window_;
  float wanted_;
  Interface interface_;
};

/// From GLFW's callbacks to the controller. Set before ImGui's, which pass events on.
class Input {
 public:
  Input(GLFWwindow* window, std::string screenshot) : window_(window), screenshot_file_(std::move(screenshot)) {
    glfwSetWindowUserPointer(window, this);
    glfwSetMouseButtonCallback(window,
                               [](GLFWwindow* w, int button, int action, int) { of(w).button(button, action); });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) { of(w).move({x, y}); });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) {
      if (of(w).controller_ && !ImGui::GetIO().WantCaptureMouse) of(w).controller_->scroll(y);
    });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
      // Who looks along the time line holds the key down.
      const bool held = action == GLFW_REPEAT && (key == GLFW_KEY_LEFT_BRACKET || key == GLFW_KEY_RIGHT_BRACKET);
      if ((action == GLFW_PRESS || held) && !ImGui::GetIO().WantTextInput) of(w).key(key);
    });
  }
  /// Whose scene is seen; null: none is, and Esc closes the window.
  void set_controller(Controller* controller) {
    controller_ = controller;
    held_ = -1;
  }
  /// Keys held down move the eye, by how long they are held.
  void fly(double seconds) {
    if (controller_ == nullptr || panels_by_keyboard_ || ImGui::GetIO().WantTextInput) return;
    const double way = seconds * 0.5 * controller_->camera.distance();
    const auto held = [&](int plus, int minus) {
      return (glfwGetKey(window_, plus) == GLFW_PRESS ? 1.0 : 0.0) -
             (glfwGetKey(window_, minus) == GLFW_PRESS ? 1.0 : 0.0);
    };
    controller_->camera.fly(way * held(GLFW_KEY_W, GLFW_KEY_S), way * held(GLFW_KEY_D, GLFW_KEY_A),
                            way * held(GLFW_KEY_E, GLFW_KEY_Q));
    const double turn = 0.5 * seconds * controller_->size().y;
    const glm::dvec2 by(held(GLFW_KEY_RIGHT, GLFW_KEY_LEFT), held(GLFW_KEY_DOWN, GLFW_KEY_UP));
    if (by != glm::dvec2(0)) controller_->drag({0, 0}, turn * by);
  }
  [[nodiscard]] glm::dvec2 pointer() const { return pointer_; }

 private:
  static Input& of(GLFWwindow* window) { return *static_cast<Input*>(glfwGetWindowUserPointer(window)); }

  void button(int which, int action) {
    if (controller_ == nullptr || (action == GLFW_PRESS && ImGui::GetIO().WantCaptureMouse)) return;
    if (action == GLFW_PRESS) {
      held_ = which;
      pressed_at_ = pointer_;
      dragged_ = false;
    } else if (which == held_) {
      held_ = -1;
      if (dragged_) return;
      if (which == GLFW_MOUSE_BUTTON_LEFT) controller_->click(pressed_at_);
      if (which == GLFW_MOUSE_BUTTON_RIGHT && controller_->hovered()) controller_->select(*controller_->hovered());
    }
  }
  void move(glm::dvec2 to) {
    constexpr double still = 4;  // pixels that a click may wander
    const glm::dvec2 from = std::exchange(pointer_, to);
    if (held_ < 0 || controller_ == nullptr) return;
    if (!dragged_ && glm::length(to - pressed_at_) < still) return;
    dragged_ = true;
    held_ == GLFW_MOUSE_BUTTON_LEFT ? controller_->drag(from, to) : controller_->drag_to_pan(from, to);
  }
  void key(int key) {
    if (controller_ == nullptr) {
      if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(window_, GLFW_TRUE);
      return;
    }
    if (key == GLFW_KEY_ESCAPE && controller_->window.photo) {
      controller_->window.photo = false;
      return;
    }
    if (key == GLFW_KEY_ESCAPE && panels_by_keyboard_) return steer_panels(false);
    if (key == GLFW_KEY_ESCAPE) controller_->key("escape");
    const bool enter = key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER;
    if (controller_->window.asks_to_leave && enter) controller_->window.leaves = true;
    if (key == GLFW_KEY_TAB) return steer_panels(!panels_by_keyboard_);
    // Arrows, space and letters are the panels' while these are steered by the keyboard.
    if (panels_by_keyboard_) return;
    if (enter && !controller_->window.asks_to_leave) controller_->key("enter");
    if (key == GLFW_KEY_P) controller_->window.picture_wanted = screenshot_file_;
    if (key == GLFW_KEY_SPACE) controller_->key("space");
    const std::pair<int, const char*> named[] = {{GLFW_KEY_PERIOD, "period"},
                                                 {GLFW_KEY_COMMA, "comma"},
                                                 {GLFW_KEY_MINUS, "minus"},
                                                 {GLFW_KEY_EQUAL, "equal"},
                                                 {GLFW_KEY_LEFT_BRACKET, "bracketleft"},
                                                 {GLFW_KEY_RIGHT_BRACKET, "bracketright"},
                                                 {GLFW_KEY_BACKSPACE, "backspace"},
                                                 {GLFW_KEY_F5, "f5"},
                                                 {GLFW_KEY_F6, "f6"},
                                                 {GLFW_KEY_F7, "f7"},
                                                 {GLFW_KEY_F8, "f8"}};
    for (const auto& [code, name] : named)
      if (key == code) controller_->key(name);
    if ((key >= GLFW_KEY_0 && key <= GLFW_KEY_9) || (key >= GLFW_KEY_A && key <= GLFW_KEY_Z))
      controller_->key(std::string(1, static_cast<char>(key >= GLFW_KEY_A ? key - GLFW_KEY_A + 'a' : key)));
  }

  /// Tab goes to the panels (arrows, space and Enter then reach all that is in them) and back.
  void steer_panels(bool on) {
    panels_by_keyboard_ = on;
    ImGuiIO& io = ImGui::GetIO();
    io.ConfigFlags =
        on ? io.ConfigFlags | ImGuiConfigFlags_NavEnableKeyboard : io.ConfigFlags & ~ImGuiConfigFlags_NavEnableKeyboard;
    controller_->window.panels_wanted = on;
    if (!on) ImGui::SetWindowFocus(nullptr);
  }

  GLFWwindow* window_;
  bool panels_by_keyboard_ = false;
  Controller* controller_ = nullptr;
  std::string screenshot_file_;
  glm::dvec2 pointer_{0}, pressed_at_{0};
  int held_ = -1;
  bool dragged_ = false;
};

/// While it lives, the window's input goes to this controller.
class Served {
 public:
  Served(Input& input, Controller& controller) : input_(input) { input_.set_controller(&controller); }
  ~Served() { input_.set_controller(nullptr); }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

 private:
  Input& input_;
};

glm::dvec2 scene_size(const Window& window, const Controller& controller) {
  return controller.window.photo ? window.size() : SidePanel::scene_size(window.size());
}
glm::ivec2 scene_pixels(const Window& window, const Controller& controller) {
  return glm::ivec2(glm::round(scene_size(window, controller) / window.size() * glm::dvec2(window.pixels())));
}

double processor_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Tells whoever waits that the first picture is there, or that none will come.
class FirstPicture {
 public:
  explicit FirstPicture(std::promise<void>& promise) : promise_(promise) {}
  ~FirstPicture() { report(); }
  FirstPicture(const FirstPicture&) = delete;
  FirstPicture& operator=(const FirstPicture&) = delete;
  void report() {
    if (!std::exchange(told_, true)) promise_.set_value();
  }

 private:
  std::promise<void>& promise_;
  bool told_ = false;
};

/// What a person does with one scene. True: another is asked for; false: the window closes. Throws what the scene's
/// simulation throws when it begins.
bool run_scene(const Window& window, Input& input, WindowInterface& interface, const Scene& scene,
               const WindowOptions& options, Speaker* speaker) {
  const double ground = ground_height(*scene.building, scene.scenario);
  SceneInstances instances(*scene.building, ground);
  Renderer renderer(instances, ground);
  // Until something is seen the processor is the picture's alone: with few cores the two would wait for each other.
  std::promise<void> drawn;
  const std::shared_future<void> seen = drawn.get_future().share();
  ThreadDriver driver(*scene.building, scene.scenario.step, [&scene, seen](std::shared_ptr<Recording> recording) {
    seen.wait();
    return std::make_unique<Session>(scene.building, scene.scenario, scene.drawn, std::move(recording),
                                     structure::StateStore::of_user());
  });
  FirstPicture first(drawn);
  Controller controller(driver, scene, ground, window.size());
  SidePanel panel;
  Outputs outputs;
  controller.resize(scene_size(window, controller));
  controller.frame_building();
  controller.window.has_sound = speaker != nullptr;
  for (const std::string& words : options.show) controller.show(words);
  const Served served(input, controller);
  glm::dvec2 hovered_at{-1};
  double before = glfwGetTime();
  while (glfwWindowShouldClose(window.get()) == GLFW_FALSE && !controller.window.leaves &&
         !controller.window.wants_another) {
    glfwPollEvents();
    interface.follow_scale();
    driver.require_beginning();
    const double now = glfwGetTime();
    input.fly(now - before);
    controller.resize(scene_size(window, controller));
    controller.update(now - before);
    before = now;
    if (input.pointer() != hovered_at && !Interface::captures_pointer()) controller.hover(hovered_at = input.pointer());
    const double started = processor_milliseconds();
    outputs.before_picture(controller);
    const Snapshot moment = controller.shown(false);
    if (speaker != nullptr) {
      speaker->set_volume(controller.window.volume);
      speaker->hear(moment, controller.camera, driver.speed());
    }
    instances.update(moment, controller.options);
    renderer.draw(instances, controller.camera, controller.options, scene_pixels(window, controller));
    outputs.after_picture(controller, renderer);
    copy_scene(renderer, 0, window.pixels());
    WindowInterface::begin_frame();
    panel.draw(controller, moment, instances, driver.error());
    if (!controller.window.photo) draw_hover_text(controller, moment);
    Interface::end_frame();
    check_gl_errors();
    controller.window.picture_processor = processor_milliseconds() - started;
    controller.window.picture_graphics = renderer.graphics_milliseconds();
    glfwSwapBuffers(window.get());
    first.report();
  }
  return controller.window.wants_another;
}

/// While it lives, arrows, space and Enter reach all that is shown.
class SteeredByKeyboard {
 public:
  SteeredByKeyboard() { ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard; }
  ~SteeredByKeyboard() { ImGui::GetIO().ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard; }
  SteeredByKeyboard(const SteeredByKeyboard&) = delete;
  SteeredByKeyboard& operator=(const SteeredByKeyboard&) = delete;
};

/// The scene that a person chooses on the start page; none: the window closes. `message`: what the page tells at first.
std::optional<Scene> choose_scene(const Window& window, WindowInterface& interface, const std::string& message) {
  StartPage page;
  page.message = message;
  const SteeredByKeyboard steered;
  while (glfwWindowShouldClose(window.get()) == GLFW_FALSE) {
    glfwWaitEventsTimeout(0.1);
    interface.follow_scale();
    const glm::ivec2 pixels = window.pixels();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, pixels.x, pixels.y);
    glClear(GL_COLOR_BUFFER_BIT);
    WindowInterface::begin_frame();
    const std::optional<std::string> chosen = page.draw();
    Interface::end_frame();
    check_gl_errors();
    glfwSwapBuffers(window.get());
    if (!chosen) continue;
    try {
      Scene scene = open_scene(*chosen);
      remember_file(*chosen);
      return scene;
    } catch (const std::exception& failed) {
      page.message = failed.what();
    }
  }
  return std::nullopt;
}

}  // namespace

void run_window(std::optional<Scene> scene, const WindowOptions& options) {
  const Window window(options.width, options.height, "Topple");
  Input input(window.get(), options.screenshot);
  WindowInterface interface(window.get(), options.scale);
  const std::unique_ptr<Speaker> speaker = options.sound ? Speaker::open() : nullptr;
  // One that was asked for by name ends the program when it cannot be run; one of the start page leads back there.
  if (scene && !run_scene(window, input, interface, *scene, options, speaker.get())) return;
  std::string message;
  for (bool another = true; another;) {
    scene = choose_scene(window, interface, message);
    if (!scene) return;
    try {
      another = run_scene(window, input, interface, *scene, options, speaker.get());
      message.clear();
    } catch (const structure::InputError& unfit) {
      message = unfit.what();
    } catch (const structure::UnstableModel& unstable) {
      message = unstable.what();
    }
  }
}

}  // namespace topple::viewer
