#pragma once
// What every target of the fuzzers needs: refusals are looked at, and there is a small building in a folder.
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>

#include "support/scratch_folder.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::fuzz {

using namespace topple::structure;

[[noreturn]] inline void found(const std::string& what) {
  std::fprintf(stderr, "fuzz: %s\n", what.c_str());
  std::abort();
}

/// Reads; a refusal has to be one printable line.
inline void promised(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    const std::string_view line = error.what();
    if (line.empty()) found("a refusal without a word");
    if (one_line(line) != line) found("a refusal that is no plain line: " + std::string(line));
  } catch (const UnstableModel&) {
    return;
  }
}

/// Two posts and a beam, with a panel between them: what scenarios and calls act on.
inline const char* const bay_model = R"({"topple": 1,
 "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850},
               "C": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 2400, "compressive_strength": 3e7}},
 "sections": {"tube": {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.015}},
 "joints": {"j": {"capacity": {"force": [1e6, 1e6, 1e6], "moment": [1e5, 1e5, 1e5]}},
            "e": {"capacity_per_length": {"tension": 4e5, "compression": 4e6, "shear_y": 4e5, "shear_z": 6e4}}},
 "nodes": {"A": [0, 0, 0], "B": [0, 0, 4], "C": [6, 0, 4], "D": [6, 0, 0]},
 "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "tube", "material": "S", "joints": ["j", null]},
             "Q": {"kind": "post", "nodes": ["D", "C"], "section": "tube", "material": "S", "joints": ["j", null]},
             "T": {"nodes": ["B", "C"], "section": "tube", "material": "S", "joints": ["j", "j"]}},
 "panels": {"W": {"kind": "wall", "nodes": ["A", "D", "C", "B"], "thickness": 0.15, "material": "C", "joint": "e"}},
 "supports": {"A": "fixed", "D": "fixed"}})";

inline const test::ScratchFolder& folder() {
  static const test::ScratchFolder own;
  [[maybe_unused]] static const bool laid = (write_file(own / "bay.json", bay_model), true);
  return own;
}

}  // namespace topple::fuzz
