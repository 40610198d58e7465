#include "contacts/near_pairs.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace topple::collision {

namespace {
btDbvtVolume volume(const Box3& box) { return btDbvtVolume::FromMM(to_bullet(box.low), to_bullet(box.high)); }
}  // namespace

NearPairs::NearPairs() : partners_(1) { colliders_.emplace_back(); }
NearPairs::~NearPairs() {
  moving_.clear();
  standing_.clear();
}

void NearPairs::insert_leaf(std::uint32_t index) {
  Collider& one = colliders_[index];
  one.leaf = (one.stands ? standing_ : moving_).insert(volume(one.fat), nullptr);
  one.leaf->dataAsInt = static_cast<int>(index);
}

/// The ground has as many partners as lie on it, and is asked for none.
void NearPairs::join(std::uint32_t a, std::uint32_t b) {
  if (a != ground) partners_[a].push_back(b);
  if (b != ground) partners_[b].push_back(a);
}

void NearPairs::part(std::uint32_t a, std::uint32_t b) {
  const auto forget = [&](std::uint32_t of, std::uint32_t other) {
    if (of == ground) return;
    std::vector<std::uint32_t>& all = partners_[of];
    *std::find(all.begin(), all.end(), other) = all.back();
    all.pop_back();
  };
  forget(a, b);
  forget(b, a);
}

/// By the shorter of the two lists: many may lie on one.
bool NearPairs::is_known(std::uint32_t a, std::uint32_t b) const {
  if (a == ground || (b != ground && partners_[b].size() < partners_[a].size())) std::swap(a, b);
  return std::find(partners_[a].begin(), partners_[a].end(), b) != partners_[a].end();
}

/// All pairs, as they lie.
void NearPairs::number_pairs() {
  free_pairs_.clear();
  order_.resize(pairs_.size());
  partners_.assign(colliders_.size(), {});
  for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
    order_[i] = i;
    const std::uint32_t first = pairs_[i].first, second = pairs_[i].second;
    join(first, second);
    PairEnds& ends = ends_[i];
    ends.first = first;
    ends.second = second;
    ends.first_order = colliders_[first].order;
    ends.second_order = colliders_[second].order;
  }
}

void NearPairs::copy(const NearPairs& of, const FindSolid& own) {
  moving_.clear();
  standing_.clear();
  colliders_ = of.colliders_;
  for (std::uint32_t i = 0; i < colliders_.size(); ++i) {
    Collider& one = colliders_[i];
    if (one.solid) one.solid = own(one.solid->kind, one.solid->id);
    if (one.leaf) insert_leaf(i);
  }
  free_colliders_ = of.free_colliders_;
  moved_ = of.moved_;
  pairs_ = of.pairs_;
  ends_ = of.ends_;
  free_pairs_ = of.free_pairs_;
  order_ = of.order_;
  partners_ = of.partners_;
  ground_height_ = of.ground_height_;
  stale_ = of.stale_;
}

void NearPairs::set_ground(Solid* solid, double height) {
  Collider& of_ground = colliders_[ground];
  of_ground.solid = solid;
  of_ground.order = std::numeric_limits<std::uint64_t>::max();
  of_ground.stands = true;
  ground_height_ = height;
  stale_ = true;
  for (std::uint32_t i = 1; i < colliders_.size(); ++i)
    if (colliders_[i].solid && !colliders_[i].stands && !colliders_[i].moved) {
      colliders_[i].moved = true;
      moved_.push_back(i);
    }
}

std::uint32_t NearPairs::add(Solid* solid, int part, std::uint64_t order, const Box3& fat) {
  std::uint32_t index;
  if (free_colliders_.empty()) {
    index = static_cast<std::uint32_t>(colliders_.size());
    colliders_.emplace_back();
    partners_.emplace_back();
  } else {
    index = free_colliders_.back();
    free_colliders_.pop_back();
  }
  Collider& made = colliders_[index];
  made = {};
  made.solid = solid;
  made.part = part;
  made.order = order;
  made.fat = made.tight = fat;
  made.stands = solid->kind != Touched::Kind::body;
  made.moved = true;
  insert_leaf(index);
  moved_.push_back(index);
  return index;
}

void NearPairs::remove(std::uint32_t index) {
  Collider& gone = colliders_[index];
  (gone.stands ? standing_ : moving_).remove(gone.leaf);
  for (std::size_t i = 0; i < order_.size();) {
    const NearPair& one = pairs_[order_[i]];
    if (one.first != index && one.second != index) {
      ++i;
      continue;
    }
    part(one.first, one.second);
    free_pairs_.push_back(order_[i]);
    order_.erase(order_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  std::erase(moved_, index);
  gone = {};
  free_colliders_.push_back(index);
}

void NearPairs::move(std::uint32_t index, const Box3& tight, double margin) {
  Collider& moving = colliders_[index];
  moving.tight = tight;
  // Bounds of what came in fast are drawn in again when it is slow.
  constexpr double far_too_large = 3;
  const double loose = std::max((moving.fat.high - tight.high).maxCoeff(), (tight.low - moving.fat.low).maxCoeff());
  if (margin > 0 && moving.fat.holds(tight) && loose <= far_too_large * margin) return;
  moving.fat.low = tight.low - Vec3::Constant(margin);
  moving.fat.high = tight.high + Vec3::Constant(margin);
  btDbvtVolume now = volume(moving.fat);
  (moving.stands ? standing_ : moving_).update(moving.leaf, now);
  if (moving.moved) return;
  moving.moved = true;
  moved_.push_back(index);
}

void NearPairs::add_pair(std::uint32_t a, std::uint32_t b) {
  join(a, b);
  if (colliders_[a].order > colliders_[b].order) std::swap(a, b);
  std::uint32_t index;
  if (free_pairs_.empty()) {
    index = static_cast<std::uint32_t>(pairs_.size());
    pairs_.emplace_back();
    ends_.emplace_back();
  } else {
    index = free_pairs_.back();
    free_pairs_.pop_back();
    pairs_[index] = {};
  }
  NearPair& made = pairs_[index];
  made.first = a;
  made.second = b;
  ends_[index] = {a, b, colliders_[a].order, colliders_[b].order};
  made_.push_back(index);
}

/// Two that have both moved find each other: the one that was added first tells of it.
void NearPairs::seek(std::size_t moved) {
  const std::uint32_t index = moved_[moved];
  const Collider& one = colliders_[index];
  std::vector<std::uint32_t>& found = found_[moved];
  found.clear();
  const auto meet = [&](std::uint32_t other) {
    const Collider& met = colliders_[other];
    if (met.solid != one.solid && !(met.moved && other < index) && !is_known(index, other)) found.push_back(other);
  };
  each_in(one.fat, false, meet);
  if (one.stands) return;
  each_in(one.fat, true, meet);
  if (colliders_[ground].solid && one.fat.low.z() <= ground_height_ && !is_known(index, ground))
    found.push_back(ground);
}

bool NearPairs::near(const PairEnds& pair) const {
  const Collider &a = colliders_[pair.first], &b = colliders_[pair.second];
  if (pair.second == ground) return b.solid && a.fat.low.z() <= ground_height_;
  return a.fat.meets(b.fat);
}

bool NearPairs::is_far(const PairEnds& pair) const {
  return (colliders_[pair.first].moved || colliders_[pair.second].moved || pair.second == ground) && !near(pair);
}

void NearPairs::find() {
  if (!changed()) return;
  std::vector<std::uint32_t> far;
  std::copy_if(order_.begin(), order_.end(), std::back_inserter(far),
               [&](std::uint32_t index) { return is_far(ends_[index]); });
  drop(far);
  for (std::size_t i = 0; i < moved_.size(); ++i) seek(i);
  take_found();
}

void NearPairs::drop(std::span<const std::uint32_t> far) {
  stale_ = false;
  if (found_.size() < moved_.size()) found_.resize(moved_.size());
  auto next = far.begin();
  std::erase_if(order_, [&](std::uint32_t index) {
    if (next == far.end() || *next != index) return false;
    ++next;
    part(ends_[index].first, ends_[index].second);
    free_pairs_.push_back(index);
    return true;
  });
}

void NearPairs::take_found() {
  made_.clear();
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    for (const std::uint32_t other : found_[i]) add_pair(moved_[i], other);
    colliders_[moved_[i]].moved = false;
  }
  moved_.clear();
  if (made_.empty()) return;
  const auto before = [&](std::uint32_t a, std::uint32_t b) { return in_order(a, b); };
  std::sort(made_.begin(), made_.end(), before);
  const auto middle = static_cast<std::ptrdiff_t>(order_.size());
  order_.insert(order_.end(), made_.begin(), made_.end());
  std::inplace_merge(order_.begin(), order_.begin() + middle, order_.end(), before);
}

}  // namespace topple::collision
