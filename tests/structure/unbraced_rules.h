#pragma once
// Rules under which nothing but a joint's own capacity breaks it.
#include "topple/structure/scenario.h"

namespace topple::test {

using namespace topple::structure;

/// No bracing, no factor of a sudden loss.
[[nodiscard]] inline FailureRules unbraced_rules() {
  FailureRules rules;
  rules.bracing = BracingRule::none;
  rules.sudden = 1;
  return rules;
}

}  // namespace topple::test
