#pragma once
#include <string>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// Warnings of parts that are most likely not meant as they are: members that end beside what they should meet, cross
/// without a joint or have the slenderness of a wire; supports that hold nothing; panels over each other, thicker than
/// wide or loaded from below; weight that lifts. `tolerance`: what is nearer is told as nodes that are not joined.
void find_odd_parts(const Building& building, double tolerance, std::vector<std::string>& warnings);

/// Warnings of strong and weak axes that do not go together: joints that bear or hold more about their section's weak
/// axis than about the strong one, members in one line of which one lies on its side.
void find_odd_joints(const Building& building, std::vector<std::string>& warnings);

}  // namespace topple::structure
