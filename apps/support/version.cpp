#include "support/version.h"

#include "commit.h"

namespace topple::app {

std::string commit() { return TOPPLE_COMMIT; }

std::string version() {
  std::string text = TOPPLE_VERSION;
  if (!commit().empty()) text += " (commit " + commit() + ")";
  return text;
}

}  // namespace topple::app
