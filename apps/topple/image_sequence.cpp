#include "image_sequence.h"

#include <stdexcept>

#ifdef TOPPLE_PICTURES
#include <algorithm>
#include <cstdio>

#include "renderer/picture_renderer.h"
#include "renderer/snapshot_taker.h"
#include "topple/structure/formats/input_files.h"

namespace topple::app {
namespace {

constexpr int width = 1280, height = 720;

bool same_picture(const viewer::Snapshot& a, const viewer::Snapshot& b) {
  return a.answer == b.answer && a.membership == b.membership && a.drawn == b.drawn &&
         std::equal(a.bodies.begin(), a.bodies.end(), b.bodies.begin(), b.bodies.end(),
                    [](const viewer::BodyPose& p, const viewer::BodyPose& q) {
                      return p.id == q.id && p.position == q.position &&
                             p.orientation.coeffs() == q.orientation.coeffs();
                    });
}

}  // namespace

struct ImageSequence::State {
  std::filesystem::path folder;
  double rate;
  viewer::PictureRenderer renderer;
  viewer::Camera camera;
  structure::VisualMesh* visual_mesh;
  viewer::SnapshotTaker taker;
  viewer::Snapshot drawn;
  std::filesystem::path last;
  std::vector<std::string> written;
  int next = 0;

  State(const structure::Simulation& simulation, std::filesystem::path where, double per_second,
        structure::VisualMesh* model)
      : folder(std::move(where)),
        rate(per_second),
        renderer(simulation.building(), viewer::ground_height(simulation.building(), simulation.scenario()), width,
                 height),
        camera(renderer.default_camera()),
        visual_mesh(model) {
    std::filesystem::create_directories(folder);
  }

  void write(const viewer::Snapshot& now) {
    char name[32];
    std::snprintf(name, sizeof name, "frame-%05d.png", next++);
    const std::filesystem::path file = folder / name;
    if (!last.empty() && same_picture(drawn, now)) {
      structure::write_file(file, structure::read_whole_file(last));
    } else {
      renderer.write(now, camera, {}, file.string());
      drawn = now;
    }
    last = file;
    written.push_back(name);
  }
};

ImageSequence::ImageSequence(const structure::Simulation& simulation, std::filesystem::path folder, double rate,
                             structure::VisualMesh* drawn)
    : state_(std::make_unique<State>(simulation, std::move(folder), rate, drawn)) {}

void ImageSequence::write_due(const structure::Simulation& simulation) {
  const double due = simulation.time() * state_->rate + 1e-6;
  if (state_->next > due) return;
  const viewer::Snapshot now = state_->taker.capture(simulation, state_->visual_mesh);
  while (state_->next <= due) state_->write(now);
}

void ImageSequence::finish(const structure::OutputFolder& folder) const {
  folder.remove_numbered("frame-", ".png", state_->written);
}

}  // namespace topple::app

#else

namespace topple::app {

struct ImageSequence::State {};
ImageSequence::ImageSequence(const structure::Simulation&, std::filesystem::path, double, structure::VisualMesh*) {
  throw std::runtime_error("--images: this program was built without its renderer (TOPPLE_VIEWER=OFF)");
}
void ImageSequence::write_due(const structure::Simulation&) {}
void ImageSequence::finish(const structure::OutputFolder&) const {}

}  // namespace topple::app

#endif

namespace topple::app {
ImageSequence::~ImageSequence() = default;
}  // namespace topple::app
