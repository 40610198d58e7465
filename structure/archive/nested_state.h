#pragma once
// An object that writes its state to a stream of its own, as a part of an archive.
#include <sstream>
#include <string>
#include <utility>

namespace topple::structure {

/// Of an object with save_state() and load_state(), which must be there: archive(NestedState{object}).
template <class Object>
struct NestedState {
  Object& object;

  template <class Archive>
  void save(Archive& archive) const {
    std::ostringstream bytes;
    object.save_state(bytes);
    archive(std::move(bytes).str());
  }
  template <class Archive>
  void load(Archive& archive) {
    std::string bytes;
    archive(bytes);
    std::istringstream from(std::move(bytes));
    object.load_state(from);
  }
};

}  // namespace topple::structure
