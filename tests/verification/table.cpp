#include "verification/table.h"

#define CATCH_CONFIG_EXTERNAL_INTERFACES  // for a listener
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <vector>

namespace topple::test {

namespace {

struct Row {
  Answer answer;
  std::string asked, test;
};
std::vector<Row>& rows() {
  static std::vector<Row> all;
  return all;
}

std::string text(const char* format, double number) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, format, number);
  return buffer;
}

double difference(const Answer& answer) {
  return answer.expected == 0 ? std::abs(answer.measured) : answer.measured / answer.expected - 1;
}

/// Rounding differs from machine to machine: below 1e-10 only that is told.
std::string told(const Answer& answer) {
  const double off = difference(answer);
  if (std::abs(off) < 1e-10) return "below 1e-10";
  return std::abs(off) < 1e-4 ? text("%.0e", std::abs(off)) : text("%+.2f %%", 100 * off);
}

void add(const Answer& answer, const std::string& asked) {
  rows().push_back({answer, asked, Catch::getResultCapture().getCurrentTestName()});
}

class Printer : public Catch::TestEventListenerBase {
 public:
  using TestEventListenerBase::TestEventListenerBase;
  void testRunEnded(const Catch::TestRunStats&) override {
    if (rows().empty()) return;
    std::cout << "| case | source | published | asked | off by | test |\n|---|---|---|---|---|---|\n";
    for (const Row& row : rows())
      std::cout << "| " << row.answer.problem << " | " << row.answer.source << " | "
                << text("%.6g", row.answer.expected) << " | " << row.asked << " | " << told(row.answer) << " | "
                << row.test << " |\n";
  }
};
CATCH_REGISTER_LISTENER(Printer)

}  // namespace

void judge(const Answer& answer, double asked) {
  INFO(answer.problem << ": " << answer.source << " has " << answer.expected << ", found " << answer.measured);
  CHECK(std::abs(difference(answer)) <= asked);
  add(answer, asked >= 1e-4 ? text("%g %%", 100 * asked) : text("%.0e", asked));
}

void show(const Answer& answer, const std::string& why) { add(answer, why); }

}  // namespace topple::test
