// A broken panel that is saved and loaded breaks on to the same bits.
#include <catch2/catch.hpp>
#include <sstream>

#include "hit_sequences.h"

using namespace topple::fracture;

namespace {

std::string state_of(const BreakablePanel& panel) {
  std::ostringstream bytes;
  panel.save_state(bytes);
  return bytes.str();
}

void load(BreakablePanel& panel, const std::string& state) {
  std::istringstream bytes(state);
  panel.load_state(bytes);
}

bool same(const Fracture& a, const Fracture& b) {
  const auto same_chunk = [](const Chunk& one, const Chunk& other) {
    return one.outline == other.outline && one.face == other.face && one.hit == other.hit;
  };
  return a.cells == b.cells && a.triangles_changed == b.triangles_changed &&
         std::equal(a.chunks.begin(), a.chunks.end(), b.chunks.begin(), b.chunks.end(), same_chunk);
}

bool same(const Mesh& a, const Mesh& b) {
  return a.positions == b.positions && a.normals == b.normals && a.texture == b.texture && a.triangles == b.triangles;
}

/// Both are hit, held and left alike; what comes out is the same in all its bits. Returns how many chunks that were.
std::size_t break_on_alike(test::Sequence& sequence, BreakablePanel& saved, BreakablePanel& loaded, test::Hit hit) {
  std::size_t chunks = 0;
  for (int i = 0; i < 6; ++i) {
    hit = test::random_hit(sequence, hit);
    CHECK(saved.holds(hit.at) == loaded.holds(hit.at));
    const Fracture expected = saved.hit(hit.at, hit.radius);
    CHECK(same(expected, loaded.hit(hit.at, hit.radius)));
    chunks += expected.chunks.size();
  }
  std::vector<bool> held(sequence.shape.outline.size());
  for (std::size_t edge = 0; edge < held.size(); ++edge) held[edge] = sequence.unit() < 0.5;
  CHECK(same(saved.hold(held), loaded.hold(held)));
  CHECK(same(saved.mesh(), loaded.mesh()));
  CHECK(saved.hits() == loaded.hits());
  CHECK(state_of(saved) == state_of(loaded));
  const Fracture rest = saved.leave();
  CHECK(same(rest, loaded.leave()));
  return chunks + rest.chunks.size();
}

}  // namespace

TEST_CASE("a panel that is loaded breaks on like the one that was saved, by each method") {
  for (const Method method : {Method::voronoi, Method::quadrilateral, Method::local}) {
    std::size_t chunks = 0;
    for (unsigned number = 0; number < 40; ++number) {
      CAPTURE(static_cast<int>(method), number);
      test::Sequence sequence = test::random_sequence(method, number);
      BreakablePanel saved(sequence.shape, sequence.settings), unsaved(saved), loaded(saved);
      test::Hit hit;
      for (unsigned i = 0; i < number % 8; ++i) {
        hit = test::random_hit(sequence, hit);
        (void)saved.hit(hit.at, hit.radius);
        (void)unsaved.hit(hit.at, hit.radius);
      }
      const std::string state = state_of(saved);
      CHECK(state_of(saved) == state);
      if (number % 2 == 0) (void)loaded.hit(Vec2(1, 1));  // whatever happened to it before
      load(loaded, state);
      CHECK(state_of(loaded) == state);
      test::Sequence again = sequence;
      BreakablePanel other(saved);
      chunks += break_on_alike(sequence, saved, loaded, hit);
      (void)break_on_alike(again, other, unsaved, hit);  // saving has changed nothing
    }
    CHECK(chunks > 500);
  }
}

TEST_CASE("a panel's state that is cut off is told") {
  test::Sequence sequence = test::random_sequence(Method::voronoi, 2);
  BreakablePanel panel(sequence.shape, sequence.settings);
  (void)panel.hit(Vec2(1, 1), 0.6);
  const std::string state = state_of(panel);
  for (std::size_t cut = 0; cut < state.size(); cut += 37) {
    BreakablePanel loaded(sequence.shape, sequence.settings);
    CHECK_THROWS_AS(load(loaded, state.substr(0, cut)), std::runtime_error);
  }
}
