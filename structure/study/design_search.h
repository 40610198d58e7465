#pragma once
// Ways of searching among designs. Each asks for designs in batches and is told what they do.
#include <functional>
#include <string>
#include <vector>

#include "topple/structure/study/study_optimise.h"

namespace topple::structure::study {

/// What is searched: variables, of which those of a choice or grid are taken from their lists.
struct SearchSpace {
  std::vector<StudyVariable> variables;
  std::uint64_t seed = 1;
  int runs = 1;
  [[nodiscard]] static bool discrete(const StudyVariable& variable) {
    return variable.distribution.kind == Distribution::Kind::choice ||
           variable.distribution.kind == Distribution::Kind::grid;
  }
};

/// Computes designs side by side, at most so many as runs are left; fewer come back when it was stopped.
using TryDesigns = std::function<std::vector<StudyDesign>(std::vector<std::vector<StudyValue>>)>;
/// True when a is better than b (K. Deb, An efficient constraint handling method for genetic algorithms, Comput.
/// Methods Appl. Mech. Engrg. 186, 2000): what keeps to all bounds before what does not, then the objective, or the
/// violation.
using Better = std::function<bool(const StudyDesign& a, const StudyDesign& b)>;

/// The cross-entropy method (R. Y. Rubinstein, D. P. Kroese, The Cross-Entropy Method, 2004): designs are drawn from
/// independent distributions, which move towards the best of all so far; every other one is a mutation of one of these.
void cross_entropy(const SearchSpace& space, const TryDesigns& attempt, const Better& better);
/// Designs at random, for comparison.
void random_search(const SearchSpace& space, const TryDesigns& attempt);
/// NLopt's COBYLA (M. J. D. Powell, 1994) or ISRES (T. P. Runarsson, X. Yao, 2005), for continuous variables alone,
/// from the middle of each. `value(design)` is to be least, each of `excess(design)` at most 0.
void nlopt_search(const SearchSpace& space, const std::string& method, const TryDesigns& attempt,
                  const std::function<double(const StudyDesign&)>& value,
                  const std::function<std::vector<double>(const StudyDesign&)>& excess, std::size_t constraints);

}  // namespace topple::structure::study
