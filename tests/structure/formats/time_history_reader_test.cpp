// Time histories from files and from a host's own numbers: what is taken, and what is refused by its place.
#include <catch2/catch.hpp>
#include <functional>
#include <limits>

#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"
#include "topple/structure/motion.h"
#include "topple/structure/time_history.h"

using namespace topple::structure;

namespace {

/// In millimetres, so that a unit that is left out shows.
const Building& post() {
  static const Building building = parse_model(R"({"topple": 1, "units": {"length": "mm", "force": "N"},
    "materials": {"s": {"youngs_modulus": 210000, "poisson_ratio": 0.3, "density": 7.85e-9}},
    "sections": {"b": {"shape": "rectangle", "depth": 100, "width": 100}},
    "nodes": {"A": [0, 0, 0], "B": [0, 0, 3000]},
    "members": {"M": {"nodes": ["A", "B"], "section": "b", "material": "s"}},
    "supports": {"A": "fixed"}, "loads": {"wind": {"nodes": {"B": {"x": 10}}}}, "combinations": {"all": {"wind": 1}}})",
                                               "post.json");
  return building;
}

std::string said(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::string refusal(const std::string& text) {
  const topple::test::ScratchFolder folder;
  write_file(folder / "h.csv", text);
  return said([&] { (void)read_time_history((folder / "h.csv").string(), post()); });
}

std::string refusal(const std::map<std::string, std::vector<double>>& columns) {
  return said([&] { (void)make_time_history(columns, post()); });
}

}  // namespace

TEST_CASE("a time history is read in the model's units, in English and in European writing, to the same numbers") {
  const topple::test::ScratchFolder folder;
  write_file(folder / "a.csv", "time,ax,wind\n0,0,1\n0.5,1500,0.25\n");
  write_file(folder / "b.csv", "\xEF\xBB\xBF\"time\";\"ax\"; wind\r\n0;0;1\r\n0,5;1500;0,25\r\n");
  for (const char* name : {"a.csv", "b.csv"}) {
    CAPTURE(name);
    const TimeHistory read = read_time_history((folder / name).string(), post());
    CHECK(read.times == std::vector<double>{0, 0.5});
    REQUIRE(read.series.size() == 2);
    CHECK(read.series[0].axis == 0);
    CHECK(read.series[0].values == std::vector<double>{0, 1.5});  // m/s2
    CHECK(read.series[1].load_case == LoadCaseId(0u));
    CHECK(read.series[1].values == std::vector<double>{1, 0.25});
  }
}

TEST_CASE("a file that is no time history is refused by its line, in characters that steer nothing") {
  CHECK(refusal("t,ax\n0,1\n1,2\n").find("line 1: the first column is \"t\"; accepted: time (s)") != std::string::npos);
  CHECK(refusal("").find("accepted: time (s)") != std::string::npos);
  CHECK(refusal("time\n0\n1\n").find("no column beside time; accepted: time, ax, ay, az, wind") != std::string::npos);
  CHECK(refusal("time,snow\n0,1\n1,2\n").find("column \"snow\"; accepted: time, ax, ay, az, wind") !=
        std::string::npos);
  CHECK(refusal("time,ax\n0,1\n0,2\n").find("line 3") != std::string::npos);
  CHECK(refusal("time,ax\n-1,1\n0,2\n").find("line 2") != std::string::npos);
  CHECK(refusal("time,ax\n0,1\n1,\n").find("no number") != std::string::npos);
  CHECK(refusal("time,wind\n0,1\n1,1e7\n").find("accepted (in SI): a number from -1e+06 to 1e+06") !=
        std::string::npos);
  CHECK(refusal("time,ax\n0,1\n").find("fewer than two rows") != std::string::npos);
  for (const char* text : {"\x1b[2Jtime,ax\n0,1\n", "time,\x1b]0;x\a\n0,1\n", "\xef\xff\x1ftime\tax\n0\t1\n1\t2\n"}) {
    const std::string line = refusal(text);
    CHECK_FALSE(line.empty());
    CHECK(one_line(line) == line);
  }
}

TEST_CASE("a host's own time history is taken as a file's is, and refused by its column") {
  const TimeHistory made = make_time_history({{"time", {0, 0.5}}, {"ay", {0, 2}}, {"wind", {1, 0}}}, post());
  CHECK(made.times == std::vector<double>{0, 0.5});
  REQUIRE(made.series.size() == 2);
  CHECK(made.series[0].axis == 1);
  CHECK(made.series[0].values == std::vector<double>{0, 2});
  CHECK(made.series[1].load_case == LoadCaseId(0u));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal({{"ax", {0, 1}}}).find("no column time") != std::string::npos);
  CHECK(refusal({{"time", {0, 1}}}).find("none beside it") != std::string::npos);
  CHECK(refusal({{"time", {0, 0}}, {"ax", {0, 1}}}).find("time[1]") != std::string::npos);
  CHECK(refusal({{"time", {0, nan}}, {"ax", {0, 1}}}).find("time[1]") != std::string::npos);
  CHECK(refusal({{"time", {0}}, {"ax", {0}}}).find("fewer than two") != std::string::npos);
  CHECK(refusal({{"time", {0, 1}}, {"ax", {0}}}).find("1 numbers; accepted: one for each of 2") != std::string::npos);
  CHECK(refusal({{"time", {0, 1}}, {"ax", {0, nan}}}).find("out of range") != std::string::npos);
  CHECK(refusal({{"time", {0, 1}}, {"snow", {0, 1}}}).find("snow") != std::string::npos);
}
