// A step that several threads share: the same bits as one thread's, whatever the host's parallel-for does.
#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <thread>

#include "same_world.h"
#include "solver/contact_domains.h"
#include "solver/parallel_region.h"
#include "topple/collision/small_steps.h"
#include "world_builder.h"

using namespace collision_test;

namespace {

void on_threads(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < count; ++i) threads.emplace_back([&work, i] { work(i); });
}

void backwards(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = count; i > 0; --i) work(i - 1);
}

/// The last call begins when the first has long ended.
void late(std::size_t count, const std::function<void(std::size_t)>& work) {
  on_threads(count - 1, work);
  work(count - 1);
}

/// Slabs and posts in a heap of some thousand contacts: it is cut into domains.
std::unique_ptr<World> large_heap() {
  auto world = make_small_steps_world();
  world->set_gravity({0, 0, -kGravity});
  world->set_ground(0, 0.6, 0.1);
  for (int i = 0; i < 360; ++i) {
    const Vec3 half = i % 3 == 0 ? Vec3(0.15, 0.15, 0.8) : Vec3(0.5, 0.4, 0.1);
    world->add_body(
        box_body(half, 2500 * 8 * half.prod(), Vec3(0.7 * (i % 12), 0.6 * (i / 12 % 5), 1 + 0.5 * (i / 60))));
  }
  return world;
}

}  // namespace

TEST_CASE("a heap falls on several threads as on one, to the bit, and in any order of calls") {
  const auto alone = large_heap();
  std::vector<std::unique_ptr<World>> shared;
  for (const auto& [how, threads] :
       std::vector<std::pair<ParallelFor, int>>{{on_threads, 2}, {on_threads, 5}, {backwards, 3}, {late, 3}}) {
    shared.push_back(large_heap());
    shared.back()->set_parallel_for(how, threads);
  }
  std::size_t most = 0;
  for (int k = 0; k < 90; ++k) {
    alone->step(kStep);
    most = std::max(most, alone->contacts().size());
    if (k == 40) shared.push_back(shared[0]->copy());  // which shares as well
    for (std::size_t i = 0; i < shared.size(); ++i) {
      shared[i]->step(kStep);
      INFO("step " << k << ", world " << i);
      require_same(*alone, *shared[i]);
    }
  }
  CHECK(most > 600);
}

TEST_CASE("a shared loop does each turn once, whoever comes, and throws what a turn threw") {
  for (const ParallelFor& how : {ParallelFor(on_threads), ParallelFor(backwards), ParallelFor(late)}) {
    ParallelRegion region(how, 3);
    std::vector<int> made(10000, 0);
    region.run([&] {
      for (int repeat = 0; repeat < 200; ++repeat)
        region.loop(made.size(), 7, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) ++made[i];
        });
      region.loop(0, 1, [](std::size_t, std::size_t) { FAIL("there is no turn to make"); });
    });
    CHECK(made == std::vector<int>(10000, 200));
    const auto failing = [&] {
      region.loop(100, 1, [](std::size_t begin, std::size_t end) {
        if (begin <= 50 && 50 < end) throw std::runtime_error("turn 50");
      });
      FAIL("it went on");
    };
    CHECK_THROWS_WITH(region.run(failing), "turn 50");
    int again = 0;
    region.run([&] { ++again; });
    CHECK(again == 1);
  }
  // Outside of a region, and without helpers: the caller's.
  ParallelRegion none;
  CHECK_FALSE(none.has_helpers());
  std::size_t count = 0;
  none.run([&] { none.loop(10, 1, [&](std::size_t begin, std::size_t end) { count += end - begin; }); });
  CHECK(count == 10);
}

TEST_CASE("contacts that threads take at once share no body, and each is taken once") {
  // Bodies in a row, each with those near it, some with the ground, some far apart.
  std::vector<ContactEnds> contacts;
  constexpr int bodies = 400;
  for (int i = 1; i <= bodies; ++i) {
    contacts.push_back({i, 0});
    for (const int next : {1, 2, 5})
      if (i + next <= bodies) contacts.push_back({i, i + next});
  }
  contacts.push_back({3, 390});
  contacts.push_back({200, bodies + 1});  // something that stands and moves
  const ContactDomains found = find_domains(contacts, bodies, 8);
  REQUIRE(found.stages.size() == 5);
  REQUIRE(found.stages.back() == found.sets.size());
  CHECK(found.sets.size() == 8 + 4 + 3 + 1);
  CHECK(found.sets.back() ==
        std::vector<std::uint32_t>{std::uint32_t(contacts.size() - 2), std::uint32_t(contacts.size() - 1)});
  std::vector<int> times(contacts.size(), 0);
  for (std::size_t stage = 0; stage + 1 < found.stages.size(); ++stage) {
    std::vector<std::size_t> owner(bodies + 2, 0);
    for (std::size_t set = found.stages[stage]; set < found.stages[stage + 1]; ++set) {
      CHECK(std::is_sorted(found.sets[set].begin(), found.sets[set].end()));
      for (const std::uint32_t i : found.sets[set]) {
        ++times[i];
        for (const int body : {contacts[i].first, contacts[i].second}) {
          if (body == 0) continue;
          auto& of = owner[static_cast<std::size_t>(body)];
          CHECK((of == 0 || of == set + 1));
          of = set + 1;
        }
      }
    }
  }
  CHECK(times == std::vector<int>(contacts.size(), 1));
  for (std::size_t set = 0; set < 8; ++set) CHECK(found.sets[set].size() == Approx(contacts.size() / 8.0).epsilon(0.1));

  // Where all lie against something that stands and moves, there is nothing to share.
  std::vector<ContactEnds> tangled;
  for (int i = 1; i <= 300; ++i) tangled.push_back({i, bodies + 1});
  const ContactDomains whole = find_domains(tangled, bodies, 8);
  CHECK(whole.sets.size() == 1);
  CHECK(whole.sets[0].size() == tangled.size());
  CHECK(find_domains({}, 0, 8).sets[0].empty());
}
