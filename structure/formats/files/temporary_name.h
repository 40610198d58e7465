#pragma once
#include <csignal>
#include <filesystem>

namespace topple::structure {

/// What is taken away when a signal ends the program (remove_temporaries_on_signals): a file, or a folder that is empty
/// then. It is named first, then made, and forgotten when it may stay; none of these but the first takes memory.
class TemporaryName {
 public:
  TemporaryName() = default;
  explicit TemporaryName(const std::filesystem::path& path);
  TemporaryName(TemporaryName&& other) noexcept;
  TemporaryName& operator=(TemporaryName&& other) noexcept;
  ~TemporaryName();

  /// Calls `create`, which makes it and says whether it did. A signal that comes meanwhile ends the program afterwards,
  /// when what was made is known.
  template <class Create>
  bool make(Create&& create) {
    const Making held;
    const bool made = create();
    if (made) known();
    return made;
  }
  void forget() noexcept;

  struct Slot;

 private:
  /// This thread is not asked to handle the signals, and another one that handles them waits. Once one does, nothing
  /// more is made: this waits for the end.
  class Making {
   public:
    Making() noexcept;
    ~Making();
    Making(const Making&) = delete;
    Making& operator=(const Making&) = delete;

   private:
    sigset_t before_;
  };

  void known() noexcept;

  Slot* slot_ = nullptr;
  char* path_ = nullptr;
};

}  // namespace topple::structure
