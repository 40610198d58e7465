#pragma once
// Reader of Frame3DD input files (.3dd), version 2014: plain numbers in a fixed order, '#' starts a comment. No units
// are declared, so the numbers stay in the file's own consistent units; nodes and elements keep their numbers as names;
// load case n becomes the combination "case n". Format: Frame3DD user manual, H. P. Gavin, section "Input data format".
#include <string>
#include <string_view>

#include "topple/structure/building.h"

namespace topple::structure {

/// Matrix condensation changes no result: it is read, checked and told in this warning.
inline constexpr const char* frame3dd_condensation_warning =
    "the file asks for matrix condensation, which is not carried out (no result depends on it)";

/// What a radius is to Frame3DD, and where JSON differs.
inline constexpr const char* frame3dd_radius_warning =
    "nodes have radii: as in Frame3DD they make elements shorter, with no arm between element and node, so that "
    "moments "
    "do not balance over them, and with weight and mass of the whole distance. `offsets` of a JSON model are arms";

/// Throws InputError with file, line, what was found and what is accepted.
[[nodiscard]] Building parse_frame3dd(std::string_view text, const std::string& name);

}  // namespace topple::structure
