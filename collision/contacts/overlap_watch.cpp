#include "topple/collision/overlap_watch.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace topple::collision {

namespace {

auto key(BodyId body, std::int64_t tag, const Touched& other) {
  return std::make_tuple(body.value, other.kind, other.body.value, other.obstacle.value, tag, other.part_tag);
}
auto key(const Contact& contact) { return key(contact.body, contact.part_tag, contact.other); }
auto key(const Overlap& overlap) { return key(overlap.body, overlap.part_tag, overlap.other); }

}  // namespace

bool Overlap::deep() const { return depth > OverlapWatch::deep_share * thickness; }

void OverlapWatch::finish(Watched& pair) {
  if (!deepest_ || pair.least.depth > deepest_->depth) deepest_ = pair.least;
  if (pair.least.deep() && !pair.counted) {
    pair.counted = true;
    ++deep_count_;
  }
  pair.since = time_;
  pair.least.depth = std::numeric_limits<double>::infinity();
}

void OverlapWatch::read(std::span<const Contact> contacts, double dt) {
  constexpr double rounding = 1e-9;  // s
  next_.clear();
  auto old = watched_.begin();
  for (const Contact& contact : contacts) {
    if (contact.depth <= tolerance) continue;
    while (old != watched_.end() && key(old->least) < key(contact)) ++old;
    const bool known = old != watched_.end() && key(old->least) == key(contact);
    Watched& pair = next_.emplace_back();
    if (known) {
      pair = *old;
    } else {
      pair.least = {contact.body, contact.part_tag, contact.other, contact.depth, contact.thickness};
      pair.since = time_;
    }
    pair.least.depth = std::min(pair.least.depth, contact.depth);
  }
  time_ += dt;
  for (Watched& pair : next_)
    if (time_ - pair.since >= lasting - rounding) finish(pair);
  watched_.swap(next_);
}

}  // namespace topple::collision
