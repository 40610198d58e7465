#pragma once
// What Frame3DD printed: displacements, end forces, reactions of each load case, frequencies.
#include <array>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/shared_data.h"

namespace topple::test {

using Printed = std::array<double, 6>;

struct Frame3ddCase {
  std::map<int, Printed> displacements, reactions;    ///< per node; left out by Frame3DD where all are zero
  std::map<std::pair<int, int>, Printed> end_forces;  ///< per element and end (0, 1), local axes
};
struct Frame3ddOutput {
  std::vector<Frame3ddCase> cases;
  std::vector<double> frequencies;
};

/// Reads NAME.out of the reference data.
inline Frame3ddOutput frame3dd_output(const std::string& name) {
  enum class Table { none, displacements, end_forces, reactions };
  Frame3ddOutput output;
  Table table = Table::none;
  std::map<int, int> seen;
  std::ifstream file(shared_path("reference/frame3dd/" + name + ".out"));
  for (std::string line; std::getline(file, line);) {
    const auto starts = [&](const char* text) { return line.rfind(text, 0) == 0; };
    if (starts("N O D E   D I S P L A C E M E N T S")) {
      table = Table::displacements;
      output.cases.emplace_back();
    } else if (starts("F R A M E   E L E M E N T   E N D   F O R C E S")) {
      table = Table::end_forces;
      seen.clear();
    } else if (starts("R E A C T I O N S")) {
      table = Table::reactions;
    } else if (starts("R M S") || starts("P E A K")) {
      table = Table::none;
    }
    const auto frequency = line.find("f=");
    if (starts("  MODE") && frequency != std::string::npos)
      output.frequencies.push_back(std::stod(line.substr(frequency + 2)));
    if (table == Table::none) continue;
    for (char& c : line)
      if (c == 't' || c == 'c') c = ' ';  // tension, compression
    std::istringstream fields(line);
    int first = 0, node = 0;
    if (!(fields >> first) || (table == Table::end_forces && !(fields >> node))) continue;
    Printed values{};
    bool whole = true;
    for (double& value : values) whole = whole && static_cast<bool>(fields >> value);
    if (!whole) continue;
    Frame3ddCase& current = output.cases.back();
    if (table == Table::displacements) current.displacements[first] = values;
    if (table == Table::reactions) current.reactions[first] = values;
    if (table == Table::end_forces) current.end_forces[{first, seen[first]++}] = values;
  }
  return output;
}

}  // namespace topple::test
