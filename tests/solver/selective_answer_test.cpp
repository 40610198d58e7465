// Selective answers: what they leave out cannot change which joint breaks next, and their bounds hold.
#include <catch2/catch.hpp>
#include <random>

#include "frames.h"
#include "joint_uses.h"

using namespace topple::test;

namespace {

using Joint = std::pair<int, int>;  // beam, end

/// A tower under its weight with joints that bear between `least` and three times of what they carry.
struct Collapsing {
  Collapsing(int posts, int storeys, unsigned seed, double least, bool walls = false) : random(seed) {
    FrameModel model = tower(posts, storeys);
    std::uniform_real_distribution<double> share(0, 1);
    for (int k = 0; walls && k < storeys; ++k) {
      const int foot = k * posts * posts;
      model.shells.push_back(
          {{foot, foot + 1, foot + posts * posts + 1, foot + posts * posts}, 30e9, 0.2, 0.2, 2400, false});
    }
    for (Beam& beam : model.beams) {
      const double size = 0.5 + share(random);
      beam.area *= size;
      beam.Iy *= size * size;
      beam.Iz *= size * size;
    }
    in_part = std::make_unique<Reanalysis>(model);
    in_full = std::make_unique<Reanalysis>(model);
    for (int i = 0; i < static_cast<int>(model.beams.size()); ++i) {
      const Beam& b = model.beams[static_cast<std::size_t>(i)];
      const Vec3 down = b.axes * Vec3(0, 0, -4000);
      const BeamLoad load = uniform_load(i, b.length, components(down.x(), down.y(), down.z(), 0, 0, 0));
      in_part->set_beam_loads(i, {load});
      in_full->set_beam_loads(i, {load});
    }
    REQUIRE(in_full->solve().stable);
    std::vector<Vec6> capacity;
    for (int i = 0; i < static_cast<int>(model.beams.size()); ++i) {
      const Vec12 forces = in_full->beam_end_forces(i);
      const double axial = std::max(std::abs(forces(0)), 3e4), shear = std::max(forces.cwiseAbs().maxCoeff(), 3e4);
      const double bending = std::max(forces.cwiseAbs().segment<2>(4).maxCoeff(), 2e4);
      capacity.push_back((least + share(random)) *
                         components(axial, shear, shear, 10 * bending, 2 * bending, 2 * bending));
    }
    uses = std::make_unique<JointUtilisations>(*in_part, capacity);
  }

  void lose(Joint joint) {
    in_part->set_end_stiffness(joint.first, joint.second, Vec6::Zero());
    in_full->set_end_stiffness(joint.first, joint.second, Vec6::Zero());
  }

  /// The joints within the margin of the largest use above 1.
  template <class UseOf>
  std::vector<Joint> next(const UseOf& use_of) const {
    double largest = 1;
    const int beams = static_cast<int>(in_full->model().beams.size());
    for (int i = 0; i < beams; ++i) largest = std::max({largest, use_of(i)[0], use_of(i)[1]});
    std::vector<Joint> result;
    for (int i = 0; i < beams; ++i)
      for (int e = 0; e < 2; ++e) {
        const double use = use_of(i)[static_cast<std::size_t>(e)];
        if (use > 1 && use >= (1 - uses->margin) * largest) result.emplace_back(i, e);
      }
    return result;
  }
  std::vector<Joint> next_in_part() const {
    return next([&](int i) { return uses->use[static_cast<std::size_t>(i)]; });
  }
  std::vector<Joint> next_in_full() const {
    return next([&](int i) { return uses->ends(*in_full, i); });
  }

  std::mt19937 random;
  std::unique_ptr<Reanalysis> in_part, in_full;
  std::unique_ptr<JointUtilisations> uses;
};

/// Largest difference of displacements, relative to the largest.
double difference(const Reanalysis& a, const Reanalysis& b) {
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < a.displacements().size(); ++n) {
    largest = std::max(largest, b.displacements()[n].norm());
    difference = std::max(difference, (a.displacements()[n] - b.displacements()[n]).norm());
  }
  return difference / largest;
}

}  // namespace

TEST_CASE("collapses break the same joints in the same order as with full answers") {
  long generations = 0, broken = 0, left = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    Collapsing c(3 + static_cast<int>(seed % 2), 4 + static_cast<int>(seed % 9), seed, 1.05 + 0.02 * (seed % 10),
                 seed % 3 == 0);
    INFO("seed " << seed);
    REQUIRE(c.in_part->solve(*c.uses).stable);
    std::vector<Joint> together{{static_cast<int>(c.random() % c.uses->use.size()), static_cast<int>(c.random() % 2)}};
    double condition = 0;  // of the last state that stands
    for (int generation = 0; generation < 12 && !together.empty(); ++generation) {
      for (const Joint& joint : together) c.lose(joint);
      const bool stands = c.in_full->solve().stable;
      REQUIRE(c.in_part->solve(*c.uses).stable == stands);
      if (!stands) break;
      condition = c.in_full->solve().quality.condition;
      together = c.next_in_full();
      REQUIRE(c.next_in_part() == together);
      ++generations;
      broken += static_cast<long>(together.size());
    }
    left += static_cast<long>(c.in_part->counters().beams_left);
    CHECK(difference(*c.in_part, *c.in_full) <= std::max(1e-10, 10 * condition * 1e-16));
  }
  CHECK(generations > 100);
  CHECK(broken > 100);
  CHECK(left > 5000);
}

TEST_CASE("no use in what was left out exceeds its bound, nor its energy") {
  long left = 0, partial = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Collapsing c(4, 6 + static_cast<int>(seed), seed, 2.0, seed % 2 == 0);
    REQUIRE(c.in_part->solve(*c.uses).stable);
    const int beams = static_cast<int>(c.uses->use.size());
    // The energy that each beam has taken since the last change, from the forces of full answers alone.
    std::vector<Vec12> before;
    for (int change = 0; change < 15; ++change) {
      before.clear();
      for (int i = 0; i < beams; ++i) before.push_back(c.in_full->beam_end_forces(i));
      c.lose({static_cast<int>(c.random() % c.uses->use.size()), static_cast<int>(c.random() % 2)});
      const std::vector<int> reads = c.uses->reads;
      if (!c.in_full->solve().stable) break;
      REQUIRE(c.in_part->solve(*c.uses).stable);
      const SelectiveEffort effort = c.in_part->selective_effort();
      if (!effort.selective) continue;
      ++partial;
      double energy = 0;
      for (int i = 0; i < beams; ++i) {
        const auto b = static_cast<std::size_t>(i);
        if (c.uses->reads[b] > reads[b]) continue;
        ++left;
        const auto use = c.uses->ends(*c.in_full, i);
        REQUIRE(std::max(use[0], use[1]) <= effort.largest_left_out);
        // Forces that changed by F2 at the second end: F2' (flexibility) F2 / 2, here with the one of axial force.
        const Beam& beam = c.in_full->model().beams[b];
        const double axial = c.in_full->beam_end_forces(i)(6) - before[b](6);
        energy += axial * axial * beam.length / (2 * beam.youngs_modulus * beam.area);
      }
      REQUIRE(energy <= effort.energy_left_out);
      REQUIRE(effort.energy_left_out <= effort.energy * (1 + 1e-7));
    }
  }
  CHECK(partial > 50);
  CHECK(left > 10000);
}

TEST_CASE("what is asked for makes a selective answer whole, to the error of a full one") {
  Collapsing c(4, 12, 5, 2.0);
  REQUIRE(c.in_part->solve(*c.uses).stable);
  for (int beam : {7, 150, 301}) {
    c.lose({beam, 1});
    REQUIRE(c.in_part->solve(*c.uses).stable);
    REQUIRE(c.in_part->selective_effort().selective);
    REQUIRE(c.in_full->solve().stable);
  }
  SECTION("displacements") { CHECK(difference(*c.in_part, *c.in_full) < 1e-11); }
  SECTION("one beam's forces") {
    for (int beam = 0; beam < static_cast<int>(c.uses->use.size()); ++beam) {
      const Vec12 a = c.in_part->beam_end_forces(beam), b = c.in_full->beam_end_forces(beam);
      CHECK((a - b).norm() < 1e-9 * 1e5);  // N: the posts bear some 1e5
    }
  }
  SECTION("reactions and energy") {
    CHECK(c.in_part->strain_energy() == Approx(c.in_full->strain_energy()).epsilon(1e-10));
    CHECK(c.in_part->reaction(0)(2) == Approx(c.in_full->reaction(0)(2)).epsilon(1e-10));
  }
  SECTION("completed with a watch, every use is read") {
    c.in_part->complete(c.uses.get());
    for (int beam = 0; beam < static_cast<int>(c.uses->use.size()); ++beam)
      CHECK(c.uses->use[static_cast<std::size_t>(beam)][0] ==
            Approx(c.uses->ends(*c.in_full, beam)[0]).epsilon(1e-8).margin(1e-8));
    CHECK(c.in_part->solve().quality.backward_error <= 1e-14);
  }
  CHECK(c.in_part->solve().quality.converged);
}

TEST_CASE("stiffening again reads every use anew, for uses grow faster then") {
  Collapsing c(3, 8, 9, 2.0);
  REQUIRE(c.in_part->solve(*c.uses).stable);
  c.lose({40, 0});
  REQUIRE(c.in_part->solve(*c.uses).stable);
  CHECK(c.in_part->selective_effort().selective);
  c.in_part->set_end_stiffness(40, 0, fixed());
  c.in_part->set_node_load(20, unit(0, 5e3));
  REQUIRE(c.in_part->solve(*c.uses).stable);
  CHECK_FALSE(c.in_part->selective_effort().selective);
}
