#pragma once
// Ids of a building's parts as bytes (solver/archive/state_archive.h).
#include "topple/structure/ids.h"

namespace topple::structure {

template <class Archive, class Tag>
void serialize(Archive& archive, Id<Tag>& id) {
  auto& [index] = id;
  archive(index);
}

}  // namespace topple::structure
