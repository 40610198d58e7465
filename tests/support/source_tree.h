#pragma once
#include <string>

namespace topple::test {

/// Path of a file of the checkout that was built, e.g. "models/seed_house.json".
std::string in_source_tree(const std::string& relative);

}  // namespace topple::test
