#pragma once
#include <string>

#include "renderer/recording.h"

namespace topple::viewer {

/// Writes a run as a glTF 2.0 animation in its binary form (.glb): y up, metres, one node for each member, panel, chunk
/// and projectile by its name, with the section's true outline, bent as the viewer draws it (to
/// structure::drawn_tolerance; morph targets that parts of one mesh share), `rate` frames a second. Throws
/// std::runtime_error when the file cannot be written.
void write_gltf(const structure::Building& building, const Recording& recording, const std::string& file,
                double rate = 30);

}  // namespace topple::viewer
