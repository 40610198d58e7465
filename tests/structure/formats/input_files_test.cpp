// Files that come in: read whole, bounded, and refused when they are none.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"

using namespace topple::structure;

namespace {

std::string refusal(const std::filesystem::path& file, std::uintmax_t most) {
  try {
    (void)read_whole_file(file, most);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a file is read whole up to the bound, and refused by its size beyond") {
  const topple::test::ScratchFolder folder;
  const std::string text(1000, 'x');
  std::ofstream(folder / "f") << text;
  CHECK(read_whole_file(folder / "f", 1000) == text);
  CHECK_NOTHROW(require_readable(folder / "f", 1000));
  CHECK_THAT(refusal(folder / "f", 999), Catch::Contains("/f: 1000 bytes; accepted: at most 999"));
  CHECK_THROWS_AS(require_readable(folder / "f", 999), InputError);
}

TEST_CASE("a file whose size the system does not know is read as far as it goes, and no further than the bound") {
  // What the kernel writes as it is read says that it has 0 bytes.
  const std::filesystem::path grows = "/proc/self/maps";
  const std::string text = read_whole_file(grows, 1 << 30);
  CHECK(text.size() > 1000);
  CHECK_THAT(refusal(grows, 100), Catch::Contains("/proc/self/maps: more than 100 bytes; accepted: fewer"));
}

TEST_CASE("what is there but cannot be read says what the system says") {
  // Its first page is not mapped: it opens as a regular file, and a read of it fails.
  CHECK_THAT(refusal("/proc/self/mem", 1 << 30), Catch::Contains("cannot be read: Input/output error; accepted"));
}

TEST_CASE("folders, pipes, devices and what is not there are no files, and nothing waits for them") {
  const topple::test::ScratchFolder folder;
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK_THAT(refusal(folder.path(), 10), Catch::Contains("is a folder; accepted: a file"));
  CHECK_THAT(refusal(folder / "pipe", 10), Catch::Contains("is no regular file"));
  CHECK_THAT(refusal("/dev/zero", 10), Catch::Contains("is no regular file"));
  CHECK_THAT(refusal(folder / "missing", 10), Catch::Contains("cannot be opened: No such file or directory"));
}

TEST_CASE("the names of a folder come in order, and a folder that is none gives its error") {
  const topple::test::ScratchFolder folder;
  for (const char* name : {"b", "a", ".c"}) std::ofstream(folder / name) << "x";
  std::error_code error = std::make_error_code(std::errc::io_error);
  CHECK(names_in(folder.path(), error) == std::vector<std::string>{".c", "a", "b"});
  CHECK_FALSE(error);
  CHECK(names_in(folder / "a", error).empty());
  CHECK(error == std::errc::not_a_directory);
}
