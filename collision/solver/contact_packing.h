#pragma once
// In which order contacts are solved: set by set of their domains, in each colour by colour, packed by four. Whoever
// takes a set goes through its packs in this order.
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "solver/contact_packs.h"
#include "solver/solver_contact.h"

namespace topple::collision {

/// Packs of the contacts of one step, and the order in which they are done.
class ContactPacking {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// Makes packs with room for rows, and tells contacts where they lie in them. Of `bodies` with what stands, those up
  /// to `ordered` came in their order along the heap; it is cut into so many domains at most.
  void pack(std::span<SolverContact> contacts, std::size_t bodies, int ordered, int most_domains);

  [[nodiscard]] std::vector<ContactPack>& packs() { return packs_; }
  [[nodiscard]] const std::vector<ContactPack>& packs() const { return packs_; }
  [[nodiscard]] std::vector<PackPoint>& points() { return points_; }
  [[nodiscard]] const std::vector<PackPoint>& points() const { return points_; }
  /// Contact of each lane of each pack, or kNone.
  [[nodiscard]] const std::vector<std::uint32_t>& packed() const { return packed_; }
  /// First pack of each set, first set of each stage, and the ends (ContactDomains).
  [[nodiscard]] const std::vector<std::size_t>& sets() const { return sets_; }
  [[nodiscard]] const std::vector<std::size_t>& stages() const { return stages_; }
  /// First pack of each colour in each set, and the end.
  [[nodiscard]] const std::vector<std::size_t>& colours() const { return colours_; }
  /// One past the last point of the packs before this one.
  [[nodiscard]] std::size_t end_of_points(std::size_t pack) const {
    return pack < packs_.size() ? packs_[pack].first_point : points_.size();
  }

 private:
  void colour(std::span<const std::uint32_t> set);
  void fill_last_packs();
  void fill_packs(std::span<const std::uint32_t> list);

  std::span<SolverContact> contacts_;  ///< while they are packed
  std::vector<ContactPack> packs_;
  std::vector<PackPoint> points_;
  std::vector<std::uint32_t> packed_;
  std::vector<std::size_t> sets_, stages_, colours_;
  std::vector<std::vector<std::uint32_t>> by_colour_;
  std::vector<std::uint64_t> used_;                        ///< of each body: its colours, a bit each, the first 64 ...
  std::map<int, std::vector<std::uint64_t>> used_beyond_;  ///< ... and those beyond, of the few that have more
};

}  // namespace topple::collision
