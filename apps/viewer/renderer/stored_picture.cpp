#include "renderer/stored_picture.h"

#include <stb_image.h>

#include <memory>

namespace topple::viewer {

std::optional<StoredPicture> read_picture(const std::filesystem::path& file) {
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> pixels(stbi_load(file.c_str(), &width, &height, &channels, 4),
                                                               stbi_image_free);
  if (!pixels) return std::nullopt;
  StoredPicture picture{make_texture(), {width, height}};
  glBindTexture(GL_TEXTURE_2D, picture.texture.get());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.get());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum way : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, way, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_2D, 0);
  return picture;
}

}  // namespace topple::viewer
