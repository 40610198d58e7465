#include "analysis/equilibrium.h"

#include <Eigen/Geometry>

namespace topple::structure {

namespace {

Vec3 centroid(const solver::FrameModel& model) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& node : model.nodes) centre += node;
  return centre / static_cast<double>(model.nodes.size());
}

/// Adds up forces and moments at places.
class Moments {
 public:
  explicit Moments(const solver::FrameModel& model) : centre_(centroid(model)) {}
  void add(const Vec3& at, const Vec3& force, const Vec3& moment) {
    Vec6 part;
    part << force, (at - centre_).cross(force) + moment;
    total.sum += part;
    total.size += part.cwiseAbs();
  }
  Balance total;

 private:
  Vec3 centre_;
};

void add_beam_load(Moments& balance, const solver::FrameModel& model, const solver::BeamLoad& load) {
  if (load.kind == solver::BeamLoad::Kind::temperature) return;  // pushes nothing as a whole
  const solver::Beam& beam = model.beams[static_cast<std::size_t>(load.beam)];
  const Vec3 start = model.nodes[static_cast<std::size_t>(beam.node[0])] + beam.offset[0];
  const auto at = [&](double x) { return Vec3(start + x * beam.axes.row(0).transpose()); };
  const auto add = [&](double x, const Vec6& local) {
    balance.add(at(x), beam.axes.transpose() * local.head<3>(), beam.axes.transpose() * local.tail<3>());
  };
  if (load.kind == solver::BeamLoad::Kind::point) {
    add(load.from, load.first);
    return;
  }
  // Two triangles of a trapezoid, each at its own centroid: exact.
  const double width = load.to - load.from;
  add(load.from + width / 3, load.first * (width / 2));
  add(load.to - width / 3, load.last * (width / 2));
}

/// A uniform traction on both triangles of a quadrilateral, each at its centroid.
void add_shell_load(Moments& balance, const solver::FrameModel& model, const solver::ShellLoad& load) {
  const auto& nodes = model.shells[static_cast<std::size_t>(load.shell)].node;
  const auto corner = [&](std::size_t i) -> const Vec3& { return model.nodes[static_cast<std::size_t>(nodes[i])]; };
  const Vec3 normal = (corner(2) - corner(0)).cross(corner(3) - corner(1)).normalized();
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
    const double area = (corner(i) - corner(0)).cross(corner(i + 1) - corner(0)).dot(normal) / 2;
    balance.add((corner(0) + corner(i) + corner(i + 1)) / 3, area * load.traction, Vec3::Zero());
  }
}

}  // namespace

Balance balance_of(const solver::FrameModel& model, const std::vector<solver::NodeLoad>& loads) {
  Moments applied(model);
  for (const solver::NodeLoad& load : loads)
    applied.add(model.nodes[static_cast<std::size_t>(load.node)], load.load.head<3>(), load.load.tail<3>());
  return applied.total;
}

Balance balance_of(const solver::FrameModel& model, const solver::LoadSet& loads) {
  Moments applied(model);
  for (const solver::BeamLoad& load : loads.beams) add_beam_load(applied, model, load);
  for (const solver::ShellLoad& load : loads.shells) add_shell_load(applied, model, load);
  return applied.total.add(balance_of(model, loads.nodes), 1);
}

Equilibrium equilibrium(const solver::FrameModel& model, const Balance& applied, const std::vector<Vec6>& reactions,
                        bool displaced) {
  Moments moments(model);
  for (std::size_t i = 0; i < reactions.size(); ++i)
    moments.add(model.nodes[static_cast<std::size_t>(model.supports[i].node)], reactions[i].head<3>(),
                reactions[i].tail<3>());
  const Balance& held = moments.total;
  Equilibrium result{applied.sum, held.sum, 0};
  // A component in which nothing but rounding acts (a symmetric frame's twist) has no error of its own: it is measured
  // against a millionth of the largest of its kind.
  constexpr double least_share = 1e-6;
  const Vec6 size = applied.size + held.size;
  for (int i = 0; i < (displaced ? 3 : 6); ++i) {
    const double scale = std::max(size[i], least_share * size.segment<3>(i < 3 ? 0 : 3).maxCoeff());
    if (scale > 0) result.error = std::max(result.error, std::abs(applied.sum[i] + held.sum[i]) / scale);
  }
  return result;
}

}  // namespace topple::structure
