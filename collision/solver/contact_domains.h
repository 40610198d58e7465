#pragma once
// Which contacts of a large heap can be solved side by side. Its bodies, in their order along the axis of its widest
// spread, are cut into domains. Contacts within one domain share no body with those of another; nor do contacts between
// a domain and the next with those between the next two. So there are four stages, of sets that threads take as they
// like: within domains, between even ones and the next, between odd ones and the next, and what is left over, one set.
// (Domain decomposition, as finite elements have it; in it, Gauss and Seidel's passes.)
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace topple::collision {

struct ContactDomains {
  std::vector<std::vector<std::uint32_t>> sets;  ///< numbers of contacts, ascending
  std::vector<std::size_t> stages;               ///< first set of each, and the end
};

/// The two bodies of a contact: their place in the heap's order from 1, 0: what stands, or above `bodies`: in no
/// domain.
struct ContactEnds {
  int first = 0, second = 0;
};

/// All contacts in one set.
[[nodiscard]] ContactDomains one_domain(std::size_t contacts);
/// At most `domains`; half as often while more than an eighth of the contacts would be left over.
[[nodiscard]] ContactDomains find_domains(std::span<const ContactEnds> contacts, int bodies, int domains);

}  // namespace topple::collision
