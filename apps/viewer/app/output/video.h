#pragma once
// A video from pictures, by ffmpeg when it is installed.
#include <sys/types.h>

#include <glm/vec2.hpp>
#include <string>

#include "renderer/renderer.h"
#include "topple/structure/formats/output_files.h"

namespace topple::viewer {

class VideoWriter {
 public:
  /// The file's ending chooses the form (.mp4, .webm ...). Throws std::runtime_error when there is no ffmpeg.
  VideoWriter(const std::string& file, glm::ivec2 size, double rate);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  /// Throws std::runtime_error when ffmpeg has given up.
  void add(const Image& image);
  /// Waits until the file is whole. Throws std::runtime_error when ffmpeg says that it failed.
  void finish();

 private:
  std::string file_;
  structure::OutputFile out_;
  pid_t process_ = -1;
  int pipe_ = -1;
};

}  // namespace topple::viewer
