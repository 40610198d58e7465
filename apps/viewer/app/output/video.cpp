#include "app/output/video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <vector>

extern char** environ;

namespace topple::viewer {
namespace {

std::string text_of(double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", number);
  return text.data();
}

}  // namespace

VideoWriter::VideoWriter(const std::string& file, glm::ivec2 size, double rate) : file_(file), out_(file) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe to ffmpeg can be made");
  // Sides of an odd number of pixels are padded: the usual forms keep colour for two by two.
  std::vector<std::string> words{"ffmpeg",
                                 "-loglevel",
                                 "error",
                                 "-y",
                                 "-f",
                                 "rawvideo",
                                 "-pix_fmt",
                                 "rgba",
                                 "-s",
                                 std::to_string(size.x) + "x" + std::to_string(size.y),
                                 "-r",
                                 text_of(rate),
                                 "-i",
                                 "-",
                                 "-vf",
                                 "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                 "-pix_fmt",
                                 "yuv420p",
                                 std::filesystem::absolute(out_.temporary()).string()};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  const int failed = posix_spawnp(&process_, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  pipe_ = ends[1];
  if (failed != 0) {
    process_ = -1;
    close(pipe_);
    throw std::runtime_error("no video can be written: ffmpeg is not installed; --record DIR writes pictures");
  }
  std::signal(SIGPIPE, SIG_IGN);  // an ffmpeg that gave up is told by write()
}

VideoWriter::~VideoWriter() {
  if (pipe_ >= 0) close(pipe_);
  if (process_ > 0) waitpid(process_, nullptr, 0);
}

void VideoWriter::add(const Image& image) {
  const std::uint8_t* next = image.pixels.data();
  for (std::size_t left = image.pixels.size(); left > 0;) {
    const ssize_t written = write(pipe_, next, left);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw std::runtime_error("ffmpeg stopped before the video " + file_ + " was whole");
    next += written;
    left -= static_cast<std::size_t>(written);
  }
}

void VideoWriter::finish() {
  close(pipe_);
  pipe_ = -1;
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  if (status != 0) throw std::runtime_error("ffmpeg could not write the video " + file_);
  out_.commit();
}

}  // namespace topple::viewer
