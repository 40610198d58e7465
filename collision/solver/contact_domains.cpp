#include "solver/contact_domains.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace topple::collision {

namespace {

/// The body of a contact that comes first in the order.
int lower(const ContactEnds& ends) {
  return ends.first == 0 ? ends.second : ends.second == 0 ? ends.first : std::min(ends.first, ends.second);
}

/// Of each body, from 1: so that each has about as many contacts.
std::vector<int> domains_by_contacts(std::span<const ContactEnds> contacts, int bodies, int domains) {
  std::vector<std::int64_t> until(static_cast<std::size_t>(bodies) + 1, 0);
  for (const ContactEnds& ends : contacts)
    if (std::max(ends.first, ends.second) <= bodies) ++until[static_cast<std::size_t>(lower(ends))];
  std::partial_sum(until.begin(), until.end(), until.begin());
  std::vector<int> domain(until.size(), 0);
  for (std::size_t i = 1; i < until.size(); ++i)
    domain[i] = static_cast<int>(until[i - 1] * domains / std::max<std::int64_t>(1, until.back()));
  return domain;
}

ContactDomains cut(std::span<const ContactEnds> contacts, int bodies, int domains) {
  const auto even = static_cast<std::size_t>(domains), odd = even + static_cast<std::size_t>(domains / 2),
             left_over = odd + static_cast<std::size_t>((domains - 1) / 2);
  ContactDomains made;
  made.sets.resize(left_over + 1);
  made.stages = {0, even, odd, left_over, left_over + 1};
  const std::vector<int> domains_of = domains_by_contacts(contacts, bodies, domains);
  const auto domain = [&](int body) { return std::min(domains - 1, domains_of[static_cast<std::size_t>(body)]); };
  const auto set_of = [&](const ContactEnds& ends) {
    if (ends.first > bodies || ends.second > bodies) return left_over;
    const int a = domain(ends.first == 0 ? ends.second : ends.first),
              b = domain(ends.second == 0 ? ends.first : ends.second);
    if (a == b) return static_cast<std::size_t>(a);
    if (std::abs(a - b) > 1) return left_over;
    const auto least = static_cast<std::size_t>(std::min(a, b));
    return (least % 2 == 0 ? even : odd) + least / 2;
  };
  for (std::uint32_t i = 0; i < contacts.size(); ++i) made.sets[set_of(contacts[i])].push_back(i);
  return made;
}

}  // namespace

ContactDomains one_domain(std::size_t contacts) {
  ContactDomains whole;
  std::vector<std::uint32_t>& all = whole.sets.emplace_back(contacts);
  std::iota(all.begin(), all.end(), 0U);
  whole.stages = {0, 1};
  return whole;
}

ContactDomains find_domains(std::span<const ContactEnds> contacts, int bodies, int domains) {
  for (; domains > 1; domains /= 2) {
    ContactDomains made = cut(contacts, bodies, domains);
    if (8 * made.sets.back().size() <= contacts.size()) return made;
  }
  return one_domain(contacts.size());
}

}  // namespace topple::collision
