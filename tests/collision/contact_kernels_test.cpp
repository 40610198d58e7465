#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "solver/contact_packs.h"

using namespace topple::collision;

namespace {

constexpr int kBodies = 40, kPacks = 30;

/// Packs of random rows, some lanes and points of which are empty, over random velocities.
struct Rows {
  std::vector<ContactPack> packs;
  std::vector<PackPoint> points;
  std::vector<Motion6> velocity, displacement;
  std::vector<PackWide> changes, ways, energies;
  std::vector<unsigned char> moves;

  explicit Rows(std::uint32_t seed) : velocity(kBodies), displacement(kBodies), moves(kBodies, 0) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1), share(0.1, 1);
    const auto fill = [&](Wide* rows, int count) {
      for (int i = 0; i < count; ++i)
        for (int lane = 0; lane < kLanes; ++lane) rows[i][lane] = any(random);
    };
    const auto fill_positive = [&](Wide& row) {
      for (int lane = 0; lane < kLanes; ++lane) row[lane] = share(random);
    };
    for (std::vector<Motion6>* motions : {&velocity, &displacement})
      for (int i = 1; i < kBodies; ++i)
        for (int k = 0; k < 3; ++k) {
          (*motions)[static_cast<std::size_t>(i)].linear[k] = any(random);
          (*motions)[static_cast<std::size_t>(i)].angular[k] = any(random);
        }
    for (int p = 0; p < kPacks; ++p) {
      std::vector<int> bodies(kBodies - 1);
      for (int i = 1; i < kBodies; ++i) bodies[static_cast<std::size_t>(i - 1)] = i;
      std::shuffle(bodies.begin(), bodies.end(), random);
      ContactPack pack{};
      pack.first_point = points.size();
      pack.point_count = 1 + p % 4;
      const int lanes = p % 5 == 0 ? 3 : kLanes;
      for (int lane = 0; lane < lanes; ++lane) {
        pack.first_body[lane] = bodies[static_cast<std::size_t>(lane)];
        pack.second_body[lane] = p % 3 == 0 && lane == 1 ? 0 : bodies[static_cast<std::size_t>(kLanes + lane)];
      }
      fill(pack.normal, 3);
      for (int i = 0; i < 2; ++i) {
        fill(pack.along[i], 3);
        fill(pack.along_first[i], 3);
        fill(pack.along_second[i], 3);
      }
      fill(pack.twist_first, 3);
      fill(pack.twist_second, 3);
      for (Wide* positive :
           {&pack.first_root, &pack.second_root, &pack.bias_rate, &pack.mass_scale, &pack.impulse_scale,
            &pack.restitution, &pack.inverse[0], &pack.inverse[2], &pack.twist_mass, &pack.friction, &pack.lever})
        fill_positive(*positive);
      for (int i = 0; i < pack.point_count; ++i) {
        PackPoint point{};
        fill(point.first, 3);
        fill(point.second, 3);
        fill(&point.separation, 1);
        fill_positive(point.mass);
        fill_positive(point.impulse);
        fill(&point.approach, 1);
        if (i == 3) point.mass[2] = 0;  // no point in this lane
        points.push_back(point);
      }
      packs.push_back(pack);
    }
    changes.resize(points.size());
    ways.resize(points.size());
    energies.resize(points.size());
  }

  /// Two sub-steps of all passes.
  void run(const ContactKernels& kernels) {
    Again again;
    again.settled = 0.1;
    again.share = 0.5;
    SubStep step{0.001, 3, 0.1};
    step.again = &again;
    const auto pass = [&](ContactKernels::Pass one) {
      return one(packs.data(), points.data(), 0, packs.size(), velocity.data(), displacement.data(), step);
    };
    pass(kernels.warm_start);
    for (int sub_step = 0; sub_step < 2; ++sub_step) {
      again.change = again.way = again.energy = nullptr;
      step.first = true;
      CHECK(pass(kernels.solve));
      again.change = &changes.data()->value;
      again.way = &ways.data()->value;
      again.energy = &energies.data()->value;
      step.first = false;
      pass(kernels.solve);
      pass(kernels.go_on);
      again.moved = nullptr;
      again.moves = moves.data();
      pass(kernels.relax);
      step.first = true;
      pass(kernels.separate);
    }
    step.restitution_from = 0.01;
    pass(kernels.restitute);
  }

  void take_in_turns() {
    for (std::size_t p = 0; p + 1 < packs.size(); ++p) {
      bool shared = false;
      for (const int* mine : {packs[p].first_body, packs[p].second_body})
        for (const int* other : {packs[p + 1].first_body, packs[p + 1].second_body})
          for (int i = 0; i < kLanes; ++i)
            for (int k = 0; k < kLanes; ++k) shared = shared || (mine[i] != 0 && mine[i] == other[k]);
      packs[p].apart_from_next = !shared;
    }
  }
};

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace

TEST_CASE("contact kernels: all instruction sets of this processor give the same bits") {
  const std::vector<const ContactKernels*> usable = usable_contact_kernels();
  REQUIRE(&contact_kernels() == usable.back());
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    Rows plain(seed);
    plain.run(*usable.front());
    for (const ContactKernels* kernels : usable) {
      Rows other(seed);
      other.run(*kernels);
      CHECK(same_bits(plain.velocity, other.velocity));
      CHECK(same_bits(plain.points, other.points));
      CHECK(same_bits(plain.packs, other.packs));
    }
  }
}

TEST_CASE("contact kernels: two packs that share no body, taken in turns, give what they give one after the other") {
  for (const ContactKernels* kernels : usable_contact_kernels()) {
    int in_turns = 0;
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      Rows one_by_one(seed), turns(seed);
      turns.take_in_turns();
      for (const ContactPack& pack : turns.packs) in_turns += pack.apart_from_next;
      one_by_one.run(*kernels);
      turns.run(*kernels);
      CHECK(same_bits(one_by_one.velocity, turns.velocity));
      CHECK(same_bits(one_by_one.points, turns.points));
      CHECK(same_bits(one_by_one.moves, turns.moves));
    }
    CHECK(in_turns > 0);
  }
}
