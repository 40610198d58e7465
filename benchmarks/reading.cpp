// Reading a model of 100,000 members from each file format: text to a checked building, every one in under a second.
//   bench_reading [MEMBERS]
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/measure.h"
#include "support/provenance.h"
#include "topple/structure/formats/files.h"

namespace {

namespace fs = std::filesystem;
using namespace topple;

/// A frame of n x n lines of posts, as many storeys as the members need: nodes by level, then posts, then beams.
struct Frame {
  struct Member {
    int first, second;
    bool post;
  };
  int lines = 0;
  std::vector<std::array<double, 3>> nodes;
  std::vector<Member> members;

  explicit Frame(std::size_t count) : lines(20) {
    const auto node = [&](int i, int j, int k) { return (k * lines + j) * lines + i; };
    for (int k = 0; members.size() < count; ++k)
      for (int j = 0; j < lines; ++j)
        for (int i = 0; i < lines; ++i) {
          nodes.push_back({6.1 * i, 7.3 * j, 3.57 * k});
          if (k == 0) continue;
          members.push_back({node(i, j, k - 1), node(i, j, k), true});
          if (i > 0) members.push_back({node(i - 1, j, k), node(i, j, k), false});
          if (j > 0) members.push_back({node(i, j - 1, k), node(i, j, k), false});
        }
  }
  [[nodiscard]] int supports() const { return lines * lines; }
};

std::string name(int node) { return "N-" + std::to_string(node); }

void write_json(const Frame& frame, const fs::path& file) {
  std::ofstream out(file);
  out << R"({"topple": 1, "materials": {"S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850, "yield_strength": 355e6}},
 "sections": {"HEB300": {"catalogue": "HEB300"}, "IPE400": {"catalogue": "IPE400"}},
 "joints": {"full": {"capacity": {"from": "section", "ratio": 0.8}}}, "nodes": {)";
  for (std::size_t n = 0; n < frame.nodes.size(); ++n)
    out << (n ? ",\n\"" : "\n\"") << name(static_cast<int>(n)) << "\": [" << frame.nodes[n][0] << ", "
        << frame.nodes[n][1] << ", " << frame.nodes[n][2] << "]";
  out << "},\n\"members\": {";
  for (std::size_t m = 0; m < frame.members.size(); ++m) {
    const Frame::Member& member = frame.members[m];
    out << (m ? ",\n\"M-" : "\n\"M-") << m << R"(": {"kind": ")" << (member.post ? "post" : "beam")
        << R"(", "nodes": [")" << name(member.first) << R"(", ")" << name(member.second) << R"("], "section": ")"
        << (member.post ? "HEB300" : "IPE400") << R"(", "material": "S355", "joints": ["full", )"
        << (member.post ? "null" : "\"full\"") << R"(], "groups": ["frame"]})";
  }
  out << "},\n\"supports\": {";
  for (int n = 0; n < frame.supports(); ++n) out << (n ? ", \"" : "\"") << name(n) << R"(": "fixed")";
  out << R"(}, "loads": {"dead": {"self_weight": 1}}})";
}

void write_frame3dd(const Frame& frame, const fs::path& file) {
  std::ofstream out(file);
  out << "Frame of " << frame.members.size() << " elements\n" << frame.nodes.size() << "\n";
  for (std::size_t n = 0; n < frame.nodes.size(); ++n)
    out << n + 1 << " " << frame.nodes[n][0] << " " << frame.nodes[n][1] << " " << frame.nodes[n][2] << " 0.0\n";
  out << frame.supports() << "\n";
  for (int n = 0; n < frame.supports(); ++n) out << n + 1 << " 1 1 1 1 1 1\n";
  out << frame.members.size() << "\n";
  for (std::size_t m = 0; m < frame.members.size(); ++m)
    out << m + 1 << " " << frame.members[m].first + 1 << " " << frame.members[m].second + 1
        << " 0.0149 0.0114 0.0033 1.85e-6 2.517e-4 8.563e-5 210e9 81e9 0.0 7850\n";
  out << "1\n0\n10.0\n1.0\n-1\n1\n0 0 -9.80665\n0\n0\n0\n0\n0\n0\n";
}

void write_tables(const Frame& frame, const fs::path& folder) {
  fs::create_directories(folder);
  std::ofstream(folder / "materials.csv")
      << "name,youngs_modulus,poisson_ratio,density,yield_strength\nS355,210e9,0.3,7850,355e6\n";
  std::ofstream(folder / "sections.csv") << "name,catalogue\nHEB300,HEB300\nIPE400,IPE400\n";
  std::ofstream nodes(folder / "nodes.csv"), members(folder / "members.csv"), supports(folder / "supports.csv");
  nodes << "name,x,y,z\n";
  for (std::size_t n = 0; n < frame.nodes.size(); ++n)
    nodes << name(static_cast<int>(n)) << "," << frame.nodes[n][0] << "," << frame.nodes[n][1] << ","
          << frame.nodes[n][2] << "\n";
  members << "name,kind,node1,node2,section,material,groups\n";
  for (std::size_t m = 0; m < frame.members.size(); ++m)
    members << "M-" << m << "," << (frame.members[m].post ? "post," : "beam,") << name(frame.members[m].first) << ","
            << name(frame.members[m].second) << "," << (frame.members[m].post ? "HEB300" : "IPE400") << ",S355,frame\n";
  supports << "node,x,y,z,rx,ry,rz\n";
  for (int n = 0; n < frame.supports(); ++n) supports << name(n) << ",fixed,fixed,fixed,fixed,fixed,fixed\n";
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 100000;
  bench::print_provenance("Reading a model: wall time, median of 5 rounds, and processor time, mean of them", 1);
  const fs::path folder = fs::temp_directory_path() / ("topple_bench_reading_" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  const Frame frame(count);
  write_json(frame, folder / "model.json");
  write_frame3dd(frame, folder / "model.3dd");
  write_tables(frame, folder / "tables");
  std::size_t read = 0;
  constexpr std::array<const char*, 3> names{"JSON", "Frame3DD", "tables"};
  constexpr std::array<const char*, 3> files{"model.json", "model.3dd", "tables"};
  std::array<double, 3> processor_time{};
  std::vector<std::function<void()>> readers;
  for (std::size_t i = 0; i < files.size(); ++i)
    readers.emplace_back([&, i] {
      const std::clock_t start = std::clock();
      read = structure::read_model(folder / files[i]).members.size();
      processor_time[i] += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    });
  constexpr int rounds = 5;
  const auto times = bench::interleaved_medians(rounds, readers);
  std::printf("%zu nodes, %zu members\n", frame.nodes.size(), read);
  for (std::size_t i = 0; i < names.size(); ++i)  // the round that warms up counts for the processor too
    std::printf("  %-10s %.3f s  (processor %.3f s)\n", names[i], times[i], processor_time[i] / (rounds + 1));
  fs::remove_all(folder);
  return 0;
}
