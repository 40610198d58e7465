#pragma once
#include <string>

#include "renderer/recording.h"

namespace topple::viewer {

/// Writes a run as Universal Scene Description in its text form (.usda): z up, metres, one prim for each member, panel,
/// chunk and projectile, with their motion as time samples (one time code for each frame at `rate` a second), bent as
/// the viewer draws them (to structure::drawn_tolerance; their points as time samples where they are). Throws
/// std::runtime_error when the file cannot be written.
void write_usd(const structure::Building& building, const Recording& recording, const std::string& file,
               double rate = 30);

}  // namespace topple::viewer
