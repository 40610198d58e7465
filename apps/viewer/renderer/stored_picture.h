#pragma once
// Pictures from files, as textures for panels.
#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>

#include "renderer/gl_object.h"

namespace topple::viewer {

struct StoredPicture {
  GlTexture texture;
  glm::ivec2 size{0};
};
/// Needs an OpenGL context. None when the file is not there or no picture.
[[nodiscard]] std::optional<StoredPicture> read_picture(const std::filesystem::path& file);

}  // namespace topple::viewer
