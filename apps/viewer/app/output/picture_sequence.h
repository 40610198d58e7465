#pragma once
// Pictures one after another: files in a folder, or a video.
#include <memory>
#include <string>

#include "app/output/video.h"

namespace topple::viewer {

class PictureSequence {
 public:
  /// A folder, which is made, holds frame-00000.png and so on.
  enum class Kind { folder, video };
  /// By its ending: .mp4, .webm, .mkv and .mov are videos.
  [[nodiscard]] static Kind kind_of(const std::string& target);
  /// "frame-00007.png"
  [[nodiscard]] static std::string picture_name(int number);
  /// Throws std::runtime_error when it cannot be written.
  PictureSequence(std::string target, double rate, Kind kind);
  void add(const Image& image);
  /// Waits until a video is whole. Throws std::runtime_error.
  void finish();
  [[nodiscard]] const std::string& target() const { return target_; }
  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] int count() const { return count_; }

 private:
  std::string target_;
  double rate_;
  Kind kind_;
  int count_ = 0;
  std::unique_ptr<VideoWriter> video_;
};

}  // namespace topple::viewer
