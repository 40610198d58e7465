#include "app/mode_shapes.h"

#include <chrono>
#include <numbers>

#include "topple/structure/analysis.h"

namespace topple::viewer {
namespace {

using structure::AnalysisRequest;
using structure::AnalysisResult;

ModeShape mode(double value, const std::vector<structure::Vec6>& shape) {
  auto drawn = std::make_shared<std::vector<Eigen::Matrix<float, 6, 1>>>();
  for (const structure::Vec6& d : shape) drawn->push_back(d.cast<float>());
  return {value, std::move(drawn)};
}

std::vector<ModeShape> find_modes(const structure::Building& building, structure::CombinationId combination,
                                  ModeKind kind) {
  AnalysisRequest request;
  request.combinations = {combination};
  (kind == ModeKind::vibration ? request.modes : request.buckling) = ModeShapes::count;
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

void ModeShapes::take(Work& work) {
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
  take(work);
  return &*work.modes;
}

const std::vector<ModeShape>& ModeShapes::wait(ModeKind kind) {
  Work& work = of(kind);
  if (!work.modes) {
    if (!work.future.valid()) start(kind);
    take(work);
  }
  return *work.modes;
}

}  // namespace topple::viewer
