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

/// Elements begin behind the radii of their nodes; Frame3DD lets their weight and mass begin at the nodes.
inline constexpr const char* frame3dd_radius_warning =
    "nodes have radii: weight and mass of elements are those between the radii, where Frame3DD counts the whole "
    "distance between nodes";

/// Throws InputError with file, line, what was found and what is accepted.
[[nodiscard]] Building parse_frame3dd(std::string_view text, const std::string& name);

}  // namespace topple::structure
