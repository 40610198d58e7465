#pragma once
// What the formats define and no part of Topple carries out yet. It is refused by its name, never ignored; when a
// feature is built, its line here goes.
#include "formats/json_document.h"
#include "topple/structure/building.h"
#include "topple/structure/files.h"

namespace topple::structure::formats {

/// Throws when this value's meaning is not built at its key ("bracing": "buckling").
void refuse_unbuilt_value(const JsonValue& value);

}  // namespace topple::structure::formats
