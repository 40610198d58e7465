// Where accuracy is lost, and whether the program says so: errors against a solution in quadruple precision along
// stiffness ratio, slenderness, chain length, unit system, near-mechanisms, sequences of damage, and the mass ratio of
// debris. One line of JSON for each case as it is done.
//   bench_stability [--members N] [--changes N] [--frames N]
// --members: of the longest chain (default 100000); --changes: of the damage sequence (default 10000); --frames: made
// by chance (default 20000), of which the sum and the worst are told.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>

#include "debris.h"
#include "judge.h"
#include "topple/solver/blas_kernel.h"

namespace {

using namespace topple::bench;

void number(const char* key, double value) {
  std::cout << ", \"" << key << "\": ";
  if (std::isfinite(value)) {
    std::cout << value;
  } else {
    std::cout << "null";
  }
}

const char* word(bool value) { return value ? "true" : "false"; }

/// One case; or the worst of `count`, of which so many were false confidence.
void print(const Verdict& v, int count = 1, int of_false_confidence = -1) {
  std::cout << "{\"family\": \"" << v.family << "\", \"what\": \"" << v.what << "\", \"way\": \"" << v.way << "\"";
  number("parameter", v.parameter);
  if (!v.refused && !v.mechanism) {
    number("error", v.error);
    number("force_error", v.force_error);
    number("bound", v.bound);
    number("backward_error", v.backward_error);
    number("condition", v.condition);
  }
  std::cout << ", \"mechanism\": " << word(v.mechanism) << ", \"refused\": " << word(v.refused)
            << ", \"warned\": " << word(v.warned) << ", \"false_alarm\": " << word(v.false_alarm())
            << ", \"count\": " << count
            << ", \"false_confidence\": " << (of_false_confidence < 0 ? int{v.false_confidence()} : of_false_confidence)
            << "}" << std::endl;
}

/// The worst of the frames by the decade of their condition, as a line each, with how many there were.
void judge_chance(int frames) {
  struct Decade {
    int count = 0, false_confidence = 0, refused = 0;
    Verdict worst;
  };
  std::map<int, Decade> decades;
  for (int seed = 1; seed <= frames; ++seed) {
    for (const Verdict& verdict : judge(chance_frame(static_cast<unsigned>(seed)))) {
      Decade& decade = decades[verdict.refused ? 99 : static_cast<int>(std::floor(std::log10(verdict.condition)))];
      ++decade.count;
      decade.refused += verdict.refused ? 1 : 0;
      decade.false_confidence += verdict.false_confidence() ? 1 : 0;
      const bool worse = verdict.error * decade.worst.bound >= decade.worst.error * verdict.bound;
      if (worse || verdict.false_confidence()) decade.worst = verdict;
    }
  }
  for (const auto& [power, decade] : decades) print(decade.worst, decade.count, decade.false_confidence);
}

void print(const DebrisVerdict& v) {
  std::cout << "{\"family\": \"debris\", \"what\": \"heavy box on a light one, side " << v.side
            << " m\", \"way\": \"collision engine\"";
  number("parameter", v.mass_ratio);
  number("error", v.error);
  number("bound", v.bound);
  number("force_error", v.force_error);
  std::cout << ", \"warned\": " << word(v.warned) << ", \"count\": 1"
            << ", \"false_confidence\": " << int{v.false_confidence()} << "}" << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  topple::solver::prepare_blas(argv);
  try {
    int members = 100000, changes = 10000, frames = 20000;
    for (int i = 1; i < argc; ++i) {
      const std::string option = argv[i];
      if (option == "--members" && i + 1 < argc) {
        members = std::stoi(argv[++i]);
      } else if (option == "--changes" && i + 1 < argc) {
        changes = std::stoi(argv[++i]);
      } else if (option == "--frames" && i + 1 < argc) {
        frames = std::stoi(argv[++i]);
      } else {
        throw std::runtime_error("usage: bench_stability [--members N] [--changes N] [--frames N]");
      }
    }
    std::cout.precision(6);
    for (const auto& cases :
         {stiffness_ratios(), slendernesses(), unit_systems(), near_mechanisms(), chains(members)}) {
      for (const Case& c : cases) {
        for (const Verdict& verdict : judge(c)) print(verdict);
      }
    }
    judge_chance(frames);
    for (const Verdict& verdict : judge_damage_sequence(changes)) print(verdict);
    for (const DebrisVerdict& verdict : judge_debris()) print(verdict);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
