// What a system has changed by since a moment, place by place, against the difference of the matrices themselves.
#include "reanalysis/system_changes.h"

#include <catch2/catch.hpp>

#include "frames.h"

namespace topple::test {
namespace {

/// Two storeys with a membrane on the ground, one foot of which stands on a spring.
FrameModel braced_tower() {
  FrameModel model = tower(2, 2);
  model.shells.push_back({{0, 1, 5, 4}, 30e9, 0.2, 0.2, 2400, false});
  model.supports.back().stiffness = Vec6::Constant(1e7);
  return model;
}

Eigen::MatrixXd dense(const SparseSymmetric& sparse) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(sparse.size, sparse.size);
  for (int column = 0; column < sparse.size; ++column)
    for (auto k = sparse.start[static_cast<std::size_t>(column)];
         k < sparse.start[static_cast<std::size_t>(column) + 1]; ++k) {
      const int row = sparse.row[static_cast<std::size_t>(k)];
      full(row, column) = full(column, row) = sparse.value[static_cast<std::size_t>(k)];
    }
  return full;
}

/// The sum of B D B' over all places.
Eigen::MatrixXd sum_of(const SystemChanges& changes, Eigen::Index size) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
  for (const auto& [place, change] : changes.all()) {
    if (!change.active()) continue;
    const ElementModes modes = changes.modes(place);
    const Eigen::MatrixXd K = modes.B * change.D * modes.B.transpose();
    for (std::size_t i = 0; i < modes.rows.size(); ++i)
      for (std::size_t j = 0; j < modes.rows.size(); ++j)
        sum(modes.rows[i], modes.rows[j]) += K(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  return sum;
}

/// Of the scaled diagonal, which is near 1: sums of twelve products each.
constexpr double rounding = 1e-12;

}  // namespace

TEST_CASE("what changed of a system, summed over its places, is the difference of its matrices") {
  FrameSystem system(braced_tower());
  system.assemble();
  const Eigen::MatrixXd then = dense(system.matrix());
  SystemChanges changes(system);

  for (const int beam : {0, 3, 5}) changes.remember_beam(beam);
  changes.remember_shell(0);
  std::vector<int> nodes{0, 1, 5, 4, 3};
  for (const int beam : {0, 3, 5}) {
    const auto& ends = system.model.beams[static_cast<std::size_t>(beam)].node;
    nodes.insert(nodes.end(), ends.begin(), ends.end());
  }
  system.model.beams[0].end_stiffness[1] = components(rigid, rigid, rigid, rigid, 0, 1e6);
  system.beam_stands[3] = 0;
  system.beam_factor[5] = 0.4;
  system.shell_stands[0] = 0;
  system.set_support(3, Vec6::Constant(3e6));
  system.reassemble(nodes);
  changes.touch(nodes);

  REQUIRE(changes.compare());
  const Eigen::MatrixXd now = dense(system.matrix());
  REQUIRE((now - then).norm() > 0.1);
  CHECK((then + sum_of(changes, then.rows()) - now).cwiseAbs().maxCoeff() < rounding);

  // As it was: every place has come back to nothing, to the bit.
  for (const int beam : {0, 3, 5}) changes.remember_beam(beam);
  const FrameModel before = braced_tower();
  system.model.beams[0].end_stiffness = before.beams[0].end_stiffness;
  system.beam_stands[3] = system.shell_stands[0] = 1;
  system.beam_factor[5] = 1;
  system.set_support(3, before.supports[3].stiffness);
  system.reassemble(nodes);
  changes.touch(nodes);
  REQUIRE(changes.compare());
  for (const auto& [place, change] : changes.all()) CHECK_FALSE(change.active());
}

TEST_CASE("a part that left is held and joined to nothing that stands, and what stands is corrected for it alone") {
  FrameSystem system(braced_tower());
  system.assemble();
  const Eigen::MatrixXd then = dense(system.matrix());
  SystemChanges changes(system);

  // The four nodes at the top, with what joins them to each other.
  std::vector<int> nodes{4, 5, 6, 7, 8, 9, 10, 11};
  for (int beam = 0; beam < static_cast<int>(system.model.beams.size()); ++beam) {
    const auto& ends = system.model.beams[static_cast<std::size_t>(beam)].node;
    if (ends[0] < 8 && ends[1] < 8) continue;
    changes.remember_beam(beam);
    system.beam_stands[static_cast<std::size_t>(beam)] = 0;
  }
  for (int node = 8; node < 12; ++node) {
    changes.drop_node(node);
    system.node_stands[static_cast<std::size_t>(node)] = 0;
  }
  system.reassemble(nodes);
  changes.touch(nodes);
  REQUIRE(changes.compare());
  CHECK(changes.any_dropped());

  const Eigen::MatrixXd corrected = then + sum_of(changes, then.rows()), now = dense(system.matrix());
  const Eigen::Index stay = system.dofs().first_equation[8], left = corrected.rows() - stay;
  REQUIRE(left == 24);  // equations in the order of nodes
  CHECK((corrected - now).topLeftCorner(stay, stay).cwiseAbs().maxCoeff() < rounding);
  CHECK(corrected.bottomLeftCorner(left, stay).cwiseAbs().maxCoeff() < rounding);
  CHECK(corrected.bottomRightCorner(left, left).ldlt().isPositive());
}

TEST_CASE("a change is extracted once, and again only when it is another") {
  FrameSystem system(braced_tower());
  system.assemble();
  SystemChanges changes(system);
  const SystemChanges::Place place{SystemChanges::Kind::beam, 2};
  const auto soften = [&](double factor) {
    changes.remember_beam(2);
    system.beam_factor[2] = factor;
    REQUIRE(changes.compare());
  };
  soften(0.5);
  CHECK_FALSE(changes.extracted(place));
  CHECK(changes.extract_changed(place) != nullptr);
  CHECK(changes.extract_changed(place) == nullptr);
  soften(0.5);
  CHECK(changes.extract_changed(place) == nullptr);
  soften(0.25);
  CHECK(changes.extract_changed(place) != nullptr);
}

}  // namespace topple::test
