#include "app/output/outputs.h"

#include <utility>

namespace topple::viewer {

void Outputs::before_picture(Controller& controller) {
  try {
    picture_ = std::exchange(controller.window.picture_wanted, {});
    const std::string target = std::exchange(controller.window.sequence_wanted, {});
    if (!target.empty() && !sequence_) {
      sequence_.emplace(target, rate, PictureSequence::kind_of(target));
      begin_ = controller.driver().recording().span()[0];
    }
  } catch (const std::exception& failed) {
    controller.message = failed.what();
  }
  if (sequence_) controller.playback().seek(begin_ + sequence_->count() / sequence_->rate());
}

void Outputs::after_picture(Controller& controller, const Renderer& scene) {
  if (picture_.empty() && !sequence_) return;
  try {
    const Image image = scene.read();
    if (!picture_.empty()) {
      write_png(image, picture_);
      controller.message = "picture written to " + std::exchange(picture_, {});
    }
    if (sequence_) add_to_sequence(controller, image);
  } catch (const std::exception& failed) {
    controller.message = failed.what();
    picture_.clear();
    sequence_.reset();
  }
}

void Outputs::add_to_sequence(Controller& controller, const Image& image) {
  constexpr double rounding = 1e-9;  // s
  sequence_->add(image);
  const double next = begin_ + sequence_->count() / sequence_->rate();
  controller.message = std::to_string(sequence_->count()) + " pictures in " + sequence_->target();
  if (next <= controller.driver().recording().span()[1] + rounding) return;
  sequence_->finish();
  sequence_.reset();
  controller.playback().seek_present();
}

}  // namespace topple::viewer
