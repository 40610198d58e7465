#pragma once
// The key `fracture`, which has one shape wherever it stands.
#include "formats/json/json_document.h"
#include "topple/fracture/panel.h"

namespace topple::structure::formats {

/// `method` and that method's keys, lengths in units of `length` (m); the seed is left as it is. Throws InputError.
[[nodiscard]] fracture::PanelSettings read_fracture(const JsonValue& value, double length = 1);

[[nodiscard]] const char* method_name(fracture::Method method);

}  // namespace topple::structure::formats
