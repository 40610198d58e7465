// How safe the factor of 2 for a sudden loss is: random members of five frames are lost, each one in time and by
// R0 + 2 (R - R0); joints' largest utilisations are compared.
//   bench_sudden_factor [LOSSES]      (default 40 of each frame)
#include <algorithm>
#include <cstdlib>
#include <random>

#include "support/provenance.h"
#include "topple/solver/blas_kernel.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/losses.h"

using namespace topple;
using namespace topple::structure;

namespace {

constexpr unsigned seed = 20021;
/// Joints that are hardly used tell nothing.
constexpr double counts_from = 0.1;
/// Told too small by no more than this share is told safely.
constexpr double close = 0.05;

struct Comparison {
  int stand = 0, mechanisms = 0;
  int safe = 0;             ///< losses whose largest use the factor does not tell too small
  int wrongly_survive = 0;  ///< told as borne, and not borne in motion
  int wrongly_fall = 0;
  long joints = 0, safe_joints = 0;
  std::vector<double> governing, each;  ///< use by the factor over use in motion
  void add(const Comparison& other) {
    stand += other.stand;
    mechanisms += other.mechanisms;
    safe += other.safe;
    wrongly_survive += other.wrongly_survive;
    wrongly_fall += other.wrongly_fall;
    joints += other.joints;
    safe_joints += other.safe_joints;
    governing.insert(governing.end(), other.governing.begin(), other.governing.end());
    each.insert(each.end(), other.each.begin(), other.each.end());
  }
};

CombinationId combination(const Building& building, const char* name) {
  for (std::size_t c = 0; c < building.combinations.size(); ++c)
    if (building.combinations[c].name == name) return CombinationId(c);
  return {};
}

void compare(const LossState& state, Comparison& sum) {
  double by_factor = 0, in_motion = 0;
  for (const JointPeak& peak : state.dynamic->joints) {
    const auto same = [&](const auto& one) { return one.first == peak.joint; };
    const auto found = std::find_if(state.joints.begin(), state.joints.end(), same);
    if (found == state.joints.end()) continue;
    by_factor = std::max(by_factor, found->second.value);
    in_motion = std::max(in_motion, peak.utilisation.value);
    if (!(peak.utilisation.value >= counts_from)) continue;
    ++sum.joints;
    sum.safe_joints += found->second.value >= (1 - close) * peak.utilisation.value ? 1 : 0;
    sum.each.push_back(found->second.value / peak.utilisation.value);
  }
  if (!(in_motion > 0)) return;
  ++sum.stand;
  sum.safe += by_factor >= in_motion ? 1 : 0;
  sum.wrongly_survive += by_factor <= 1 && in_motion > 1 ? 1 : 0;
  sum.wrongly_fall += by_factor > 1 && in_motion <= 1 ? 1 : 0;
  sum.governing.push_back(by_factor / in_motion);
}

Comparison lose_some(const char* model, int losses) {
  const Building building = read_model(find_model(model));
  std::vector<MemberId> members;
  for (std::size_t m = 0; m < building.members.size(); ++m) members.emplace_back(m);
  std::mt19937 draw(seed);
  // By hand: std::shuffle differs between libraries.
  for (std::size_t m = members.size() - 1; m > 0; --m) std::swap(members[m], members[draw() % (m + 1)]);
  members.resize(std::min(members.size(), static_cast<std::size_t>(losses)));
  LossRequest request;
  request.named = members;
  request.motion.asked = true;
  const LossResult result = find_losses(building, {combination(building, "collapse")}, request, {});
  Comparison sum;
  for (const MemberLoss& loss : result.losses)
    for (const LossState& state : loss.states) {
      if (state.dynamic)
        compare(state, sum);
      else
        ++sum.mechanisms;
    }
  return sum;
}

double at(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print(const char* name, const Comparison& c) {
  std::printf("| %s | %d | %d | %d | %d | %d | %.2f, %.2f, %.2f | %.1f %% of %ld | %.2f, %.2f, %.2f |\n", name, c.stand,
              c.mechanisms, c.safe, c.wrongly_survive, c.wrongly_fall, at(c.governing, 0), at(c.governing, 0.5),
              at(c.governing, 1),
              c.joints > 0 ? 100.0 * static_cast<double>(c.safe_joints) / static_cast<double>(c.joints) : 0.0, c.joints,
              at(c.each, 0), at(c.each, 0.5), at(c.each, 1));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  solver::prepare_blas(argv);
  const int losses = argc > 1 ? std::atoi(argv[1]) : 40;
  if (losses < 1) {
    std::fprintf(stderr, "usage: bench_sudden_factor [LOSSES]\n");
    return 2;
  }
  bench::print_provenance("The factor of 2 for sudden losses against their motion", 1);
  std::printf(
      "| frame | losses that stand | mechanisms | 2 is safe | told to survive, and fail | told to fail, and survive | "
      "largest use, by 2 over in motion: least, median, most | joints told safely | each joint: least, median, most "
      "|\n");
  Comparison all;
  for (const char* model : {"seed_building", "house", "tower", "hall", "bridge"}) {
    const Comparison own = lose_some(model, losses);
    print(model, own);
    all.add(own);
  }
  print("all", all);
  return 0;
}
