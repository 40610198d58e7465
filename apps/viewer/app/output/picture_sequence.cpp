#include "app/output/picture_sequence.h"

#include <array>
#include <cstdio>
#include <filesystem>

namespace topple::viewer {

PictureSequence::Kind PictureSequence::kind_of(const std::string& target) {
  const std::string ending = std::filesystem::path(target).extension().string();
  return ending == ".mp4" || ending == ".webm" || ending == ".mkv" || ending == ".mov" ? Kind::video : Kind::folder;
}

std::string PictureSequence::picture_name(int number) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "frame-%05d.png", number);
  return name.data();
}

PictureSequence::PictureSequence(std::string target, double rate, Kind kind)
    : target_(std::move(target)), rate_(rate), kind_(kind) {
  if (kind_ == Kind::folder) std::filesystem::create_directories(target_);
}

void PictureSequence::add(const Image& image) {
  if (kind_ == Kind::video) {
    if (!video_) video_ = std::make_unique<VideoWriter>(target_, glm::ivec2(image.width, image.height), rate_);
    video_->add(image);
  } else {
    write_png(image, (std::filesystem::path(target_) / picture_name(count_)).string());
  }
  ++count_;
}

void PictureSequence::finish() {
  if (video_) video_->finish();
}

}  // namespace topple::viewer
