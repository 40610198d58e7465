#pragma once
#include <filesystem>

namespace topple::structure {

/// What is taken away when a signal ends the program (remove_temporaries_on_signals): a file, or a folder that is empty
/// then. It is named first, then made and known, and forgotten when it may stay; none of these but the first takes
/// memory.
class TemporaryName {
 public:
  TemporaryName() = default;
  explicit TemporaryName(const std::filesystem::path& path);
  TemporaryName(TemporaryName&& other) noexcept;
  TemporaryName& operator=(TemporaryName&& other) noexcept;
  ~TemporaryName();

  /// It has been made.
  void known() noexcept;
  void forget() noexcept;

  struct Slot;

 private:
  Slot* slot_ = nullptr;
  char* path_ = nullptr;
};

}  // namespace topple::structure
