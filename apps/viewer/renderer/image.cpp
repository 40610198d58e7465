// The only place that knows how pictures are written; stb's implementation comes from the system's library.
#include <stb_image_write.h>

#include <stdexcept>

#include "renderer/renderer.h"
#include "topple/structure/formats/output_files.h"

namespace topple::viewer {

void write_png(const Image& image, const std::string& file) {
  structure::OutputFile out(file);
  // What fails is kept in the stream: this is called from C.
  const auto take = [](void* stream, void* bytes, int size) {
    static_cast<std::ostream*>(stream)->write(static_cast<const char*>(bytes), size);
  };
  if (stbi_write_png_to_func(take, &out.stream(), image.width, image.height, 4, image.pixels.data(), 4 * image.width) ==
      0)
    throw std::runtime_error("cannot make the picture " + file);
  out.commit();
}

}  // namespace topple::viewer
