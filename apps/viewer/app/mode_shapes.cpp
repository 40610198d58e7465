#include "app/mode_shapes.h"

#include <Eigen/Geometry>
#include <chrono>
#include <numbers>

#include "topple/structure/analysis.h"
#include "topple/structure/divide_member.h"

namespace topple::viewer {
namespace {

using structure::AnalysisRequest;
using structure::AnalysisResult;

/// Posts are divided to see them bulge between nodes that rest, unless that makes too much of the building.
constexpr std::size_t most_divided = 3000;
constexpr double divided_at = 0.5;

ModeShape mode(double value, const std::vector<structure::Vec6>& shape) {
  auto drawn = std::make_shared<std::vector<Eigen::Matrix<float, 6, 1>>>();
  for (const structure::Vec6& d : shape) drawn->push_back(d.cast<float>());
  return {value, std::move(drawn), nullptr};
}

/// A building whose posts have a node in their middle, behind all nodes of the whole one.
struct DividedPosts {
  structure::Building building;
  std::vector<std::pair<std::size_t, std::size_t>> middles;  ///< member, node
  explicit DividedPosts(const structure::Building& whole) : building(whole) {
    for (std::size_t m = 0; m < whole.members.size(); ++m) {
      if (whole.members[m].kind != structure::MemberKind::post) continue;
      middles.emplace_back(m, building.nodes.size());
      (void)structure::divide_member(building, structure::MemberId(m), {divided_at});
    }
  }
};

/// What the middle does beside the cubic between the ends, across the member, by what the node there does.
structure::Vec3 bulge_of(const structure::Member& member, const std::vector<structure::Vec6>& shape,
                         const structure::Vec3& moves) {
  constexpr double s = divided_at, r = 1 - s;
  const structure::Vec3 x = member.axes.row(0).transpose();
  structure::Vec3 beside = moves;
  const std::array<double, 2> by_way{r * r * (1 + 2 * s), s * s * (1 + 2 * r)}, by_slope{s * r * r, -s * s * r};
  for (std::size_t e = 0; e < 2; ++e) {
    const structure::Vec6& d = shape[static_cast<std::size_t>(member.nodes[e].index)];
    const structure::Vec3 turn = d.tail<3>();
    beside -= by_way[e] * (d.head<3>() + turn.cross(member.offsets[e])) + member.length * by_slope[e] * turn.cross(x);
  }
  // What is drawn is 16 s2 (1 - s)2 of the middle's.
  return (beside - x * x.dot(beside)) / (16 * s * s * r * r);
}

ModeShape buckling_mode(const structure::Building& whole, const DividedPosts& divided, double factor,
                        const std::vector<structure::Vec6>& shape) {
  ModeShape found = mode(factor, {shape.begin(), shape.begin() + static_cast<std::ptrdiff_t>(whole.nodes.size())});
  auto bulge = std::make_shared<std::vector<Eigen::Vector3f>>(whole.members.size(), Eigen::Vector3f::Zero());
  for (const auto& [member, node] : divided.middles)
    (*bulge)[member] = bulge_of(whole.members[member], shape, shape[node].head<3>()).cast<float>();
  found.bulge = std::move(bulge);
  return found;
}

std::vector<ModeShape> divided_buckling(const structure::Building& whole, const AnalysisRequest& request) {
  const DividedPosts divided(whole);
  const AnalysisResult result = structure::analyse(divided.building, request);
  std::vector<ModeShape> modes;
  for (const auto& one : result.combinations.at(0).buckling)
    modes.push_back(buckling_mode(whole, divided, one.factor, one.shape));
  return modes;
}

std::vector<ModeShape> find_modes(const structure::Building& building, structure::CombinationId combination,
                                  ModeKind kind) {
  AnalysisRequest request;
  request.combinations = {combination};
  (kind == ModeKind::vibration ? request.modes : request.buckling) = ModeShapes::count;
  if (kind == ModeKind::buckling && building.members.size() <= most_divided) return divided_buckling(building, request);
  const AnalysisResult result = structure::analyse(building, request);
  std::vector<ModeShape> modes;
  if (kind == ModeKind::vibration)
    for (const auto& one : result.modes)
      modes.push_back(mode(one.angular_frequency / (2 * std::numbers::pi), one.shape));
  else
    for (const auto& one : result.combinations.at(0).buckling) modes.push_back(mode(one.factor, one.shape));
  return modes;
}

}  // namespace

void ModeShapes::start(ModeKind kind) {
  of(kind).future = std::async(std::launch::async, [building = building_, combination = combination_, kind] {
    return find_modes(*building, combination, kind);
  });
}

void ModeShapes::store(Work& work) {
  try {
    work.modes = work.future.get();
    if (work.modes->empty()) work.error = "there are none";
  } catch (const std::exception& failed) {
    work.modes.emplace();
    work.error = failed.what();
  }
}

const std::vector<ModeShape>* ModeShapes::find(ModeKind kind) {
  Work& work = of(kind);
  if (work.modes) return &*work.modes;
  if (!work.future.valid()) start(kind);
  if (work.future.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return nullptr;
  store(work);
  return &*work.modes;
}

const std::vector<ModeShape>& ModeShapes::wait_for(ModeKind kind) {
  Work& work = of(kind);
  if (!work.modes) {
    if (!work.future.valid()) start(kind);
    store(work);
  }
  return *work.modes;
}

}  // namespace topple::viewer
