// Every file that is written is whole under its name, or not there: whatever is in the way.
#include "topple/structure/formats/output_files.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <sstream>

#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"

using namespace topple::structure;
using topple::test::ScratchFolder;
namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t count(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// As a full disk: no file of this process may grow beyond so many bytes.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

}  // namespace

TEST_CASE("a file takes its name when it is whole, and the old one is whole until then") {
  const ScratchFolder folder;
  const fs::path file = folder / "a.txt";
  write_file(file, "old");
  {
    OutputFile out(file);
    out.write("new");
    out.stream() << " and more";
    CHECK(text_of(file) == "old");
    CHECK(count(folder.path()) == 2);
    CHECK(out.temporary().extension() == ".txt");
    out.commit();
    CHECK(text_of(file) == "new and more");
  }
  {
    OutputFile out(file);
    out.write("never finished");
  }
  CHECK(text_of(file) == "new and more");
  CHECK(count(folder.path()) == 1);
}

TEST_CASE("on a full disk the old files stay whole, no temporary is left, and the reason is told") {
  const ScratchFolder folder;
  write_files(folder.path(), {{"a", "old a"}, {"b", "old b"}});
  const std::string large(1 << 20, 'x');
  for (const std::size_t room : {0, 1, 65536, 100000}) {
    {
      const FullDisk disk(room);
      CHECK_THROWS_WITH(write_files(folder.path(), {{"a", "new a"}, {"b", large}}), Catch::Contains("cannot write"));
      CHECK_THROWS_WITH(write_files(folder.path(), {}, {{"b", [&](const auto& sink) { sink(large); }}}),
                        Catch::Contains("File too large"));
      OutputFile streamed(folder / "a");
      streamed.stream() << large;
      CHECK_THROWS(streamed.commit());
    }
    CHECK(text_of(folder / "a") == "old a");
    CHECK(text_of(folder / "b") == "old b");
    CHECK(count(folder.path()) == 2);
  }
}

TEST_CASE("links are replaced and not followed, devices, pipes and folders are refused") {
  const ScratchFolder folder;
  write_file(folder / "kept", "kept");
  fs::create_symlink("kept", folder / "link");
  write_file(folder / "link", "new");
  CHECK(text_of(folder / "kept") == "kept");
  CHECK_FALSE(fs::is_symlink(folder / "link"));
  fs::create_directory(folder / "sub");
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  for (const fs::path& target :
       {folder / "sub", folder / "pipe", fs::path("/dev/null"), fs::path("/proc/version"), folder / "no/such/folder/x",
        folder / "kept/x", folder / std::string(300, 'x'), fs::path()})
    CHECK_THROWS_AS(OutputFile(target), InputError);
  CHECK(count(folder.path()) == 4);
}

TEST_CASE("two runs do not write into one folder, and a folder made for nothing goes again") {
  const ScratchFolder folder;
  const fs::path results = folder / "deep/results";
  {
    const OutputFolder first(results, {}, {});
    CHECK_THROWS_WITH(OutputFolder(results, {}, {}), Catch::Contains("another run"));
  }
  CHECK_FALSE(fs::exists(results));
  {
    const OutputFolder again(results, {}, {});
    write_files(results, {{"results.json", "{}"}});
  }
  CHECK(count(results) == 1);
}

TEST_CASE("what is read is never overwritten, under whatever name it is given") {
  const ScratchFolder folder;
  write_file(folder / "results.json", "{}");
  fs::create_hard_link(folder / "results.json", folder / "model.json");
  fs::create_symlink("results.json", folder / "other.json");
  for (const char* name : {"results.json", "model.json", "other.json", "./results.json"}) {
    CHECK_THROWS_AS(OutputFolder(folder.path(), {folder / name}, {"results.json", "*.csv"}), InputError);
    CHECK_THROWS_AS(require_different(folder / "results.json", folder / name), InputError);
  }
  CHECK_NOTHROW(OutputFolder(folder.path(), {folder / "results.json"}, {"summary.json"}));
}

TEST_CASE("numbered files of an earlier run go, others stay") {
  const ScratchFolder folder;
  for (const char* name :
       {"chunk-1.glb", "chunk-2.glb", "chunk-10.glb", "chunk-x.glb", "chunk-1.obj", "my-chunk-1.glb"})
    write_file(folder / name, name);
  const OutputFolder results(folder.path(), {}, {});
  results.remove_numbered("chunk-", ".glb", {"chunk-1.glb"});
  CHECK(fs::exists(folder / "chunk-1.glb"));
  CHECK_FALSE(fs::exists(folder / "chunk-2.glb"));
  CHECK_FALSE(fs::exists(folder / "chunk-10.glb"));
  CHECK(count(folder.path()) == 4);
}

TEST_CASE("only regular files of a size that can be held are read, and the reason is the true one") {
  const ScratchFolder folder;
  write_file(folder / "a", "text");
  CHECK(read_whole_file(folder / "a") == "text");
  CHECK_THROWS_WITH(read_whole_file(folder / "a", 3), Catch::Contains("4 bytes"));
  CHECK_THROWS_WITH(read_whole_file(folder / "none"), Catch::Contains("No such file"));
  CHECK_THROWS_WITH(read_whole_file(folder.path()), Catch::Contains("is a folder"));
  CHECK_THROWS_WITH(read_whole_file("/dev/zero"), Catch::Contains("no regular file"));
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(read_whole_file(folder / "pipe"), Catch::Contains("no regular file"));
  fs::create_symlink("loop", folder / "loop");
  CHECK_THROWS_WITH(read_whole_file(folder / "loop"), Catch::Contains("symbolic links"));
  if (geteuid() != 0) {
    fs::permissions(folder / "a", fs::perms::none);
    CHECK_THROWS_WITH(read_whole_file(folder / "a"), Catch::Contains("Permission denied"));
  }
}
