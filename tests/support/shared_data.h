#pragma once
// Reference data that lies beside the project. A test that needs it skips with a message where it is absent.
#include <filesystem>
#include <iostream>
#include <string>

#include "support/source_tree.h"

namespace topple::test {

/// Path of a file of the reference data, e.g. "reference/opensees/A1_def_L1.json".
inline std::filesystem::path shared_path(const std::string& relative) {
  return in_source_tree("../shared/" + relative);
}

/// True when the file exists; else tells CTest (through its skip expression) why the test is skipped.
inline bool have_shared(const std::string& relative) {
  if (std::filesystem::exists(shared_path(relative))) return true;
  std::cout << "SKIPPED: reference data " << relative << " is not here\n";
  return false;
}

}  // namespace topple::test
