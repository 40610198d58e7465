#pragma once
// Every file that is written goes through here. A file is made under a temporary name of its own beside its target and
// takes its name when it is whole: at any moment, and after a crash, the old file is whole or the new one is.
//
// The temporary is opened with O_EXCL under a name that nobody has, so that two runs never share one and no link is
// followed; each write is checked; what replaces a file is on the disk (fsync) before it takes the name.
#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace topple::structure {

class TemporaryName;

/// A file while it is written. Without commit() nothing is left of it.
class OutputFile {
 public:
  /// Throws InputError where no file can be made there: there is no such folder, no right to write, or what has the
  /// name is no regular file. A link at the target is replaced, not followed.
  explicit OutputFile(std::filesystem::path target);
  /// Moves: what is moved from may only be destroyed or assigned to.
  OutputFile(OutputFile&&) noexcept;
  /// Moves, as the constructor does.
  OutputFile& operator=(OutputFile&&) noexcept;
  /// Takes the temporary away unless the file has its name.
  ~OutputFile();

  /// Throws std::runtime_error with the path and the reason.
  void write(std::string_view text);
  /// The same as a stream; what fails is told by finish().
  [[nodiscard]] std::ostream& stream();
  /// For a program that writes the file itself: the temporary, whose ending is the target's.
  [[nodiscard]] const std::filesystem::path& temporary() const;
  /// As it was given.
  [[nodiscard]] const std::filesystem::path& target() const;

  /// Writes out what is left and closes the temporary. Throws std::runtime_error.
  void finish();
  /// Gives the file its name; finish() comes first by itself. Throws std::runtime_error.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// From now on SIGINT, SIGTERM and SIGHUP, where they would end the program, first take away what is being written and
/// folders that were made for it: for programs. A host that has handlers of its own keeps them.
void remove_temporaries_on_signals();

/// The text as one file: OutputFile, written and committed.
void write_file(const std::filesystem::path& target, std::string_view text);

/// Throws InputError where OutputFile would: to be asked before the work whose result goes there.
void require_writable(const std::filesystem::path& target);
/// Throws InputError when both are one file.
void require_different(const std::filesystem::path& input, const std::filesystem::path& output);

/// A file that is made as it is written: `write` hands its text to a sink, in order.
struct StreamedFile {
  std::string name;                                                              ///< in the folder
  std::function<void(const std::function<void(std::string_view)>& sink)> write;  ///< makes it
};
using NamedFiles = std::vector<std::pair<std::string, std::string>>;  ///< names and texts

/// Writes files into a folder (made when it is not there): each takes its name when every one is whole, so that a fault
/// before leaves all as it was. Throws std::runtime_error with the path and the reason.
void write_files(const std::filesystem::path& folder, const NamedFiles& files,
                 const std::vector<StreamedFile>& streamed = {});

/// The folder of one run's results, claimed before the work begins and until it ends.
class OutputFolder {
 public:
  /// Makes the folder. Throws InputError when files cannot be made in it, when another run has claimed it, or when one
  /// of `inputs` has a name there that one of `results` will have ("*" at the end of a name stands for anything).
  OutputFolder(std::filesystem::path folder, const std::vector<std::filesystem::path>& inputs,
               const std::vector<std::string>& results);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  /// A folder that was made for nothing goes again.
  ~OutputFolder();
  /// As it was given.
  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  /// Takes away the files named PREFIX, digits, ENDING that are not among `kept`: those of an earlier run.
  void remove_numbered(std::string_view prefix, std::string_view ending, const std::vector<std::string>& kept) const;

 private:
  std::filesystem::path folder_;
  bool made_ = false;
  int claim_ = -1;
  std::unique_ptr<TemporaryName> name_;  ///< while the folder is new: it goes when a signal ends the program
};

}  // namespace topple::structure
