#pragma once
// What the command lines of all programs share: numbers of options, and how a run ends.
#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "topple/structure/number_range.h"

namespace topple::app {

/// Exit statuses of the command line.
enum Status { success = 0, failure = 1, bad_input = 2, unstable = 3 };

/// Accepts finite numbers in a range: for every option that takes a number with a point.
[[nodiscard]] inline CLI::Validator in_range(const structure::NumberRange& range) {
  return CLI::Validator(
      [range](const std::string& given) {
        const auto number = structure::number_of(given);
        return number && range.contains(*number) ? std::string() : "found \"" + given + "\"; accepted: " + range.text();
      },
      "NUMBER");
}

/// Accepts whole numbers from `least` to `most`.
[[nodiscard]] inline CLI::Validator whole_number(int least, int most) {
  return CLI::Validator(
      [least, most](const std::string& given) {
        const auto number = structure::number_of(given);
        const bool whole = number && given.find_first_not_of("+-0123456789") == std::string::npos;
        return whole && *number >= least && *number <= most
                   ? std::string()
                   : "found \"" + given + "\"; accepted: a whole number from " + std::to_string(least) + " to " +
                         std::to_string(most);
      },
      "WHOLE");
}

/// A line on standard error, safe for a terminal: "PROGRAM: what". Returns the status.
int print_error(const char* program, const std::string& what, Status status);

/// Runs a program to its end: every error becomes one line and a status, and so does what standard output did not take.
/// Errors of the command line itself are `run`'s to catch, as CLI::ParseError.
[[nodiscard]] int run_program(const char* program, const std::function<int()>& run);

}  // namespace topple::app
