#pragma once
// Ids as array subscripts.
#include "topple/structure/ids.h"

namespace topple::structure {

template <class Tag>
[[nodiscard]] constexpr std::size_t index_of(Id<Tag> id) {
  return static_cast<std::size_t>(id.index);
}

}  // namespace topple::structure
