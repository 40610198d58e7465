// Samples of la3 against separate factorisations and solves: the study's overhead, as a ratio within one run.
//
// Both sides on one thread, in turns. A factorisation and solve is what solver::StaticAnalysis does for the frame of
// the building: numbering, ordering, assembly, factor, and the answers of all combinations. A sample is all that
// `topple study la3_steel` does for one: inputs, the model with them, analysis, outputs, the line of the journal.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "topple/solver/static_analysis.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/frame.h"
#include "topple/structure/study/study.h"

namespace {

using namespace topple::structure;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main() {
  const Building building = read_model(find_model("la3"));
  const StudyTask task = study_task(read_study(find_study("la3_steel")));
  const auto evaluator = task.make_evaluator();
  const Frame frame = make_frame(building);
  std::vector<topple::solver::LoadSet> loads;
  for (std::size_t c = 0; c < building.combinations.size(); ++c) {
    const PartLoads parts = part_loads(building, CombinationId(c));
    loads.push_back(on_frame(building, frame, parts, load_set(building, parts)));
  }
  std::vector<double> solves, samples, ratios;
  std::size_t bytes = 0;
  constexpr std::uint64_t turns = 50, each = 20;
  for (std::uint64_t turn = 0; turn < turns; ++turn) {
    const double start = now();
    for (std::uint64_t i = 0; i < each; ++i) {
      topple::solver::StaticAnalysis analysis(frame.model);
      bytes += analysis.solve(loads).size();
    }
    const double middle = now();
    for (std::uint64_t i = 0; i < each; ++i)
      bytes += journal_line(task, run_sample(task, *evaluator, turn * each + i)).size();
    const double end = now();
    solves.push_back((middle - start) / each);
    samples.push_back((end - middle) / each);
    ratios.push_back(samples.back() / solves.back());
  }
  std::printf(
      "%llu samples of la3: %.2f ms each, a separate factorisation and solve %.2f ms; ratio %.3f (medians; %zu)\n",
      static_cast<unsigned long long>(turns * each), 1e3 * median(samples), 1e3 * median(solves), median(ratios),
      bytes);
}
