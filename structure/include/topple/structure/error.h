#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace topple::structure {

/// Bad input: one line that names the file, the place in it, what is wrong and what is accepted. Exit status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A model that is not stable: what() says which nodes (by name) move how, and which members. Exit status 3.
class UnstableModel : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace topple::structure
