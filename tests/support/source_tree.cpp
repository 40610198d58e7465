#include "support/source_tree.h"

namespace topple::test {

std::string in_source_tree(const std::string& relative) { return TOPPLE_SOURCE_DIR "/" + relative; }

}  // namespace topple::test
