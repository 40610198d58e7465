// The only place that knows how pictures are written; stb's implementation comes from the system's library.
#include <stb_image_write.h>

#include <stdexcept>

#include "renderer/renderer.h"

namespace topple::viewer {

void write_png(const Image& image, const std::string& file) {
  if (stbi_write_png(file.c_str(), image.width, image.height, 4, image.pixels.data(), 4 * image.width) == 0)
    throw std::runtime_error("cannot write the picture '" + file + "'");
}

}  // namespace topple::viewer
