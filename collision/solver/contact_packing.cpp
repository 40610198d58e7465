#include "solver/contact_packing.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "solver/contact_domains.h"

namespace topple::collision {

namespace {

ContactDomains domains_of(std::span<const SolverContact> contacts, int ordered, int most) {
  if (most == 1) return one_domain(contacts.size());
  std::vector<ContactEnds> ends;
  ends.reserve(contacts.size());
  for (const SolverContact& contact : contacts) ends.push_back({contact.first, contact.second});
  return find_domains(ends, ordered, most);
}

}  // namespace

void ContactPacking::pack(std::span<SolverContact> contacts, std::size_t bodies, int ordered, int most_domains) {
  ContactDomains domains = domains_of(contacts, ordered, most_domains);
  contacts_ = contacts;
  first_points_.clear();
  packed_.clear();
  point_count_ = 0;
  colours_.clear();
  sets_.clear();
  used_.assign(bodies, 0);
  for (const auto& set : domains.sets) {
    sets_.push_back(first_points_.size());
    colour(set);
    if (domains.sets.size() > 1) fill_last_packs();
    for (const auto& list : by_colour_)
      if (!list.empty()) lay_out(list);
  }
  sets_.push_back(first_points_.size());
  colours_.push_back(first_points_.size());
  if (packs_.size() < first_points_.size()) packs_.resize(first_points_.size());
  if (points_.size() < point_count_) points_.resize(point_count_);
  stages_ = std::move(domains.stages);
}

/// No body twice in a colour. In the order of contacts, so that it follows from handles.
void ContactPacking::colour(std::span<const std::uint32_t> set) {
  for (auto& list : by_colour_) list.clear();
  const auto word = [&](int body, std::size_t w) -> std::uint64_t {
    if (w == 0) return used_[static_cast<std::size_t>(body)];
    const auto beyond = used_beyond_.find(body);
    return beyond == used_beyond_.end() || w > beyond->second.size() ? 0 : beyond->second[w - 1];
  };
  const auto mark = [&](int body, std::size_t chosen) {
    if (body == 0) return;
    const std::size_t w = chosen / 64;
    const std::uint64_t bit = std::uint64_t{1} << (chosen % 64);
    if (w == 0) {
      used_[static_cast<std::size_t>(body)] |= bit;
      return;
    }
    auto& beyond = used_beyond_[body];
    if (beyond.size() < w) beyond.resize(w, 0);
    beyond[w - 1] |= bit;
  };
  for (const std::uint32_t i : set) {
    const SolverContact& contact = contacts_[i];
    std::size_t chosen = 0;
    for (std::size_t w = 0;; ++w) {
      const std::uint64_t taken = word(contact.first, w) | word(contact.second, w);
      if (taken == std::numeric_limits<std::uint64_t>::max()) continue;
      chosen = 64 * w + static_cast<std::size_t>(__builtin_ctzll(~taken));
      break;
    }
    mark(contact.first, chosen);
    mark(contact.second, chosen);
    if (by_colour_.size() <= chosen) by_colour_.resize(chosen + 1);
    by_colour_[chosen].push_back(i);
  }
  // Few lanes of a pack stay without a point.
  const auto points = [&](std::uint32_t i) { return contacts_[i].points; };
  for (auto& list : by_colour_)
    std::stable_sort(list.begin(), list.end(), [&](std::uint32_t a, std::uint32_t b) { return points(a) > points(b); });
  for (const std::uint32_t i : set)
    for (const int body : {contacts_[i].first, contacts_[i].second}) used_[static_cast<std::size_t>(body)] = 0;
  used_beyond_.clear();
}

/// The colours of a small set are short: lanes that stay free in the last pack of one take contacts of later colours.
/// They are solved earlier then, which is no matter to one thread.
void ContactPacking::fill_last_packs() {
  for (std::size_t c = 0; c + 1 < by_colour_.size(); ++c) {
    auto& list = by_colour_[c];
    const auto shares_body = [&](std::uint32_t i) {
      const SolverContact& contact = contacts_[i];
      return std::any_of(list.end() - static_cast<std::ptrdiff_t>(list.size() % kLanes), list.end(),
                         [&](std::uint32_t other) {
                           const SolverContact& of = contacts_[other];
                           return (contact.first != 0 && (contact.first == of.first || contact.first == of.second)) ||
                                  (contact.second != 0 && (contact.second == of.first || contact.second == of.second));
                         });
    };
    for (std::size_t later = by_colour_.size() - 1; later > c && list.size() % kLanes != 0; --later) {
      auto& from = by_colour_[later];
      for (std::size_t i = 0; i < from.size() && list.size() % kLanes != 0;)
        if (shares_body(from[i])) {
          ++i;
        } else {
          list.push_back(from[i]);
          from.erase(from.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
  }
}

/// Of one colour.
void ContactPacking::lay_out(std::span<const std::uint32_t> list) {
  colours_.push_back(first_points_.size());
  for (std::size_t begin = 0; begin < list.size(); begin += kLanes) {
    int points = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t i = begin + lane < list.size() ? list[begin + lane] : kNone;
      packed_.push_back(i);
      if (i != kNone) points = std::max(points, contacts_[i].points);
    }
    first_points_.push_back(point_count_);
    point_count_ += static_cast<std::size_t>(points);
  }
}

bool ContactPacking::share_a_body(std::size_t one, std::size_t other) const {
  const auto has = [&](int body) {
    return body != 0 && std::any_of(lanes(other).begin(), lanes(other).end(), [&](std::uint32_t i) {
             return i != kNone && (contacts_[i].first == body || contacts_[i].second == body);
           });
  };
  return std::any_of(lanes(one).begin(), lanes(one).end(), [&](std::uint32_t i) {
    return i != kNone && (has(contacts_[i].first) || has(contacts_[i].second));
  });
}

void ContactPacking::begin(std::size_t pack) {
  ContactPack& begun = packs_[pack];
  begun = ContactPack{};
  begun.first_point = first_points_[pack];
  begun.point_count = static_cast<int>(end_of_points(pack + 1) - begun.first_point);
  std::fill_n(points_.begin() + static_cast<std::ptrdiff_t>(begun.first_point), begun.point_count, PackPoint{});
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t i = lanes(pack)[lane];
    if (i == kNone) continue;
    contacts_[i].pack = static_cast<int>(pack);
    contacts_[i].lane = static_cast<int>(lane);
    begun.first_body[lane] = contacts_[i].first;
    begun.second_body[lane] = contacts_[i].second;
  }
  begun.apart_from_next = pack + 1 < first_points_.size() && !share_a_body(pack, pack + 1);
}

}  // namespace topple::collision
