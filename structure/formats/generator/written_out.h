#pragma once
// A model whose building generators are written out.
#include <string>

#include "formats/json/json_document.h"

namespace topple::structure::formats {

[[nodiscard]] bool has_generator(const JsonDocument& model);

/// The same model with every part that its generators make as a part by itself, with the keys of its rule; the text of
/// a JSON model. Generated parts come before listed ones, in the order in which they are analysed. Throws InputError.
[[nodiscard]] std::string written_out(const JsonDocument& model);

}  // namespace topple::structure::formats
