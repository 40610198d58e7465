#pragma once
// Pictures that a person asks for while looking: one of what is seen, or the whole recorded run from where the eye is.
#include <optional>

#include "app/controller.h"
#include "app/output/picture_sequence.h"

namespace topple::viewer {

class Outputs {
 public:
  static constexpr double rate = 30;  ///< pictures for each simulated second
  /// Before the scene is drawn: takes up what was asked for, and looks at the moment whose picture comes next.
  void before_picture(Controller& controller);
  /// When the scene, without the panels, has been drawn. What fails is told in the controller's message.
  void after_picture(Controller& controller, const Renderer& scene);
  /// More pictures of a sequence are to come.
  [[nodiscard]] bool busy() const { return sequence_.has_value(); }

 private:
  void add_to_sequence(Controller& controller, const Image& image);
  std::optional<PictureSequence> sequence_;
  std::string picture_;
  double begin_ = 0;  ///< s, of the sequence
};

}  // namespace topple::viewer
