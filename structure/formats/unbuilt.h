#pragma once
// What the formats define and no part of Topple carries out yet. It is refused by its name, never ignored; when a
// feature is built, its line here goes.
#include "formats/json_document.h"
#include "topple/structure/building.h"
#include "topple/structure/files.h"

namespace topple::structure::formats {

/// Where keys stand that the reader has nowhere to keep.
enum class UnbuiltPlace { model, material, panel, scenario, failure, cut, event };

/// Throws at a key of this object whose meaning is not built.
void refuse_unbuilt_keys(const JsonValue& object, UnbuiltPlace place);
/// Throws when this value's meaning is not built at its key ("bracing": "buckling").
void refuse_unbuilt_value(const JsonValue& value);

}  // namespace topple::structure::formats
