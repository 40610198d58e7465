#pragma once
// What a model says that its engineer most likely does not mean.
#include <string>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// Nodes nearer than this to each other, or to a member, are meant to be one, or on it, m.
inline constexpr double usual_join_tolerance = 1e-3;

/// One line each, with names: nodes that lie on members without being joined, nodes that all but coincide, members laid
/// over each other, materials whose stiffness, strength or density no material has, members
/// far deeper than long, load cases in no combination, loads a thousandth of what is usual. Many of a kind are counted,
/// three of them named. Empty for a sound model.
[[nodiscard]] std::vector<std::string> modelling_warnings(const Building& building);

/// What a name may have been meant to be: the known one that differs least, " (did you mean X?)"; empty where none is
/// near (a third of its letters).
[[nodiscard]] std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

}  // namespace topple::structure
