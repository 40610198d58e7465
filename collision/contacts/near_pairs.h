#pragma once
// Pairs of parts whose bounds are near each other, in an order that follows from handles alone. Bounds are larger than
// the parts, so that what lies still is never sought again. Trees of bounds are Bullet's.
#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "contacts/manifold.h"
#include "contacts/polyhedra_contacts.h"
#include "shapes/solid.h"

namespace topple::collision {

struct Box3 {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  [[nodiscard]] bool holds(const Box3& other) const {
    return (low.array() <= other.low.array()).all() && (high.array() >= other.high.array()).all();
  }
  [[nodiscard]] bool meets(const Box3& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};
template <class Archive>
void serialize(Archive& archive, Box3& of) {
  auto& [low, high] = of;
  archive(low, high);
}

/// One convex part in the world.
struct Collider {
  Solid* solid = nullptr;
  int part = 0;
  std::uint64_t order = 0;  ///< bodies by id and part, then obstacles, then the ground
  double gone = 0;          ///< m: no point of its solid has come farther, step by step, since it was added
  double way = 0;           ///< m: none comes farther in the next step
  bool moves = false;       ///< in the next step
  Box3 fat, tight;          ///< tight: with what the next step may move it
  btDbvtNode* leaf = nullptr;
  bool stands = false, moved = false;
};
/// All but what points at others: NearPairs names the solid.
template <class Archive>
void serialize(Archive& archive, Collider& of) {
  auto& [solid, part, order, gone, way, moves, fat, tight, leaf, stands, moved] = of;
  archive(part, order, gone, way, moves, fat, tight, stands, moved);
}

/// What is asked of every pair in every step, apart from what few are asked for.
struct PairEnds {
  std::uint32_t first = 0, second = 0;              ///< colliders, by order
  std::uint64_t first_order = 0, second_order = 0;  ///< of the colliders
  double free_until = -1;  ///< m: there is no contact before the two have come so far together, by what they have gone
  bool touches = false;    ///< there are contacts
  bool rests = false;      ///< it has borne something that sleeps
};
/// What is not told by the pair and its colliders.
template <class Archive>
void serialize(Archive& archive, PairEnds& of) {
  auto& [first, second, first_order, second_order, free_until, touches, rests] = of;
  archive(free_until, touches, rests);
}

/// Turns of a loop by which a pair is asked for before it is needed: pairs of neighbours are far from each other in
/// memory.
inline constexpr std::size_t kAhead = 4;
/// Asks for all lines of memory that it lies in.
template <class T>
void prefetch_lines(const T& of) {
  constexpr std::size_t line = 64;
  for (std::size_t byte = 0; byte < sizeof(T); byte += line)
    __builtin_prefetch(reinterpret_cast<const char*>(&of) + byte);
}

struct alignas(64) NearPair {
  std::uint32_t first = 0, second = 0;  ///< colliders, by order
  Manifold manifold;
  SeparatingAxis axis;
  Mat3 turn = Mat3::Identity();    ///< of the second in the first's frame when contacts were last sought ...
  Vec3 shift = Vec3::Zero();       ///< ... and its place
  double clear = -1;               ///< m: no contact before the second has moved so far; below zero: not known
  double margin = 0;               ///< m, with which they were sought
  Vec3 rest_force = Vec3::Zero();  ///< on the second, of two of which one sleeps at least: what it rests with, N
  Vec3 pressed = Vec3::Zero();     ///< the same, averaged over the last steps
  bool sought = false;
  std::uint64_t told_in = 0;  ///< the last step that told of it
  bool persistent = false;    ///< it touched in the step before the last
  bool touches = false;       ///< it pushed in the last step, or lay close
};
template <class Archive>
void serialize(Archive& archive, NearPair& of) {
  auto& [first, second, manifold, axis, turn, shift, clear, margin, rest_force, pressed, sought, told_in, persistent,
         touches] = of;
  archive(first, second, manifold, axis, turn, shift, clear, margin, rest_force, pressed, sought, told_in, persistent,
          touches);
}

class NearPairs {
 public:
  static constexpr std::uint32_t ground = 0;  ///< collider of the half space

  NearPairs();
  ~NearPairs();
  NearPairs(const NearPairs&) = delete;
  NearPairs& operator=(const NearPairs&) = delete;

  /// Gives the solid of a world by its kind and number.
  using FindSolid = std::function<Solid*(Touched::Kind kind, std::int64_t id)>;
  /// All that `of` holds, of solids that `own` gives for its own.
  void copy(const NearPairs& of, const FindSolid& own);
  /// The same by way of an archive. Pairs are written in their order, and numbered by it when they are read.
  template <class Archive>
  void save(Archive& archive) const;
  template <class Archive>
  void load(Archive& archive, const FindSolid& own);
  void set_ground(Solid* solid, double height);
  std::uint32_t add(Solid* solid, int part, std::uint64_t order, const Box3& fat);
  void remove(std::uint32_t collider);
  /// Where the part is now or will be before the next step; bounds are made anew, larger by `margin`, when it is
  /// outside of them (always, with a margin of zero).
  void move(std::uint32_t collider, const Box3& tight, double margin);
  /// What its solid has come, in all, and may come in the next step (Collider).
  void note_way(std::uint32_t collider, double gone, double way, bool moves) {
    Collider& of = colliders_[collider];
    of.gone = gone;
    of.way = way;
    of.moves = moves;
  }
  /// Brings the pairs up to date.
  void find();
  // The same in parts: pairs that are no longer near (`far`, in order) go; what is new is sought for each collider that
  // moved, in any order and side by side; it is taken in.
  [[nodiscard]] bool changed() const { return !moved_.empty() || stale_; }
  [[nodiscard]] bool is_far(const PairEnds& pair) const;
  void drop(std::span<const std::uint32_t> far);
  [[nodiscard]] std::size_t moved_count() const { return moved_.size(); }
  void seek(std::size_t moved);
  void take_found();

  /// Whether the one pair comes before the other, in order of their colliders.
  [[nodiscard]] bool in_order(std::uint32_t a, std::uint32_t b) const {
    const PairEnds &first = ends_[a], &second = ends_[b];
    return first.first_order != second.first_order ? first.first_order < second.first_order
                                                   : first.second_order < second.second_order;
  }
  [[nodiscard]] const Collider& collider(std::uint32_t index) const { return colliders_[index]; }
  /// In order of their colliders.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
  [[nodiscard]] NearPair& pair(std::uint32_t index) { return pairs_[index]; }
  [[nodiscard]] const NearPair& pair(std::uint32_t index) const { return pairs_[index]; }
  [[nodiscard]] PairEnds& ends(std::uint32_t index) { return ends_[index]; }
  [[nodiscard]] const PairEnds& ends(std::uint32_t index) const { return ends_[index]; }
  /// Colliders whose bounds meet the box.
  template <class Call>
  void each_in(const Box3& box, bool standing, const Call& call) const;

 private:
  void insert_leaf(std::uint32_t collider);
  void number_pairs();
  void add_pair(std::uint32_t a, std::uint32_t b);
  void join(std::uint32_t a, std::uint32_t b);
  void part(std::uint32_t a, std::uint32_t b);
  [[nodiscard]] bool is_known(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] bool near(const PairEnds& pair) const;

  btDbvt moving_, standing_;
  std::vector<Collider> colliders_;
  std::vector<std::uint32_t> free_colliders_, moved_;
  std::vector<NearPair> pairs_;
  std::vector<PairEnds> ends_;  ///< of each pair
  std::vector<std::uint32_t> free_pairs_, order_, made_;
  std::vector<std::vector<std::uint32_t>> partners_;  ///< of each collider: those that it is a pair with
  std::vector<std::vector<std::uint32_t>> found_;     ///< for each that moved: its new partners
  double ground_height_ = 0;
  bool stale_ = false;  ///< a collider has gone
};

template <class Archive>
void NearPairs::save(Archive& archive) const {
  // Trees are built of the colliders; partners are told by the pairs; `made` and `found` are room.
  const auto& [moving, standing, colliders, free_colliders, moved, pairs, ends, free_pairs, order, made, partners,
               found, ground_height, stale] = *this;
  archive(std::uint64_t{colliders.size()}, std::uint64_t{order.size()}, free_colliders, moved, ground_height, stale);
  for (const Collider& one : colliders) {
    archive(one, one.solid != nullptr);
    if (one.solid) archive(one.solid->kind, one.solid->id);
  }
  for (const std::uint32_t index : order) archive(pairs[index], ends[index]);
}

template <class Archive>
void NearPairs::load(Archive& archive, const FindSolid& own) {
  std::uint64_t collider_count = 0, pair_count = 0;
  archive(collider_count, pair_count, free_colliders_, moved_, ground_height_, stale_);
  moving_.clear();
  standing_.clear();
  colliders_.assign(collider_count, {});
  for (std::uint32_t i = 0; i < collider_count; ++i) {
    bool has_solid = false;
    archive(colliders_[i], has_solid);
    if (!has_solid) continue;
    Touched::Kind kind{};
    std::int64_t id = -1;
    archive(kind, id);
    colliders_[i].solid = own(kind, id);
    if (i != ground) insert_leaf(i);
  }
  pairs_.assign(pair_count, {});
  ends_.assign(pair_count, {});
  for (std::size_t i = 0; i < pair_count; ++i) archive(pairs_[i], ends_[i]);
  number_pairs();
}

template <class Call>
void NearPairs::each_in(const Box3& box, bool standing, const Call& call) const {
  struct Collect : btDbvt::ICollide {
    const Call& visit;
    explicit Collect(const Call& c) : visit(c) {}
    void Process(const btDbvtNode* leaf) override { visit(static_cast<std::uint32_t>(leaf->dataAsInt)); }
  } collect(call);
  const btDbvt& tree = standing ? standing_ : moving_;
  tree.collideTV(tree.m_root, btDbvtVolume::FromMM(to_bullet(box.low), to_bullet(box.high)), collect);
}

}  // namespace topple::collision
