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

  /// Lays packs out, with room for rows. Of `bodies` with what stands, those up to `ordered` came in their order along
  /// the heap; it is cut into so many domains at most. Packs are empty until each is begun.
  void pack(std::span<SolverContact> contacts, std::size_t bodies, int ordered, int most_domains);
  /// Tells the contacts of a pack where they lie, and the pack which bodies they have. Side by side, in any order.
  void begin(std::size_t pack);

  [[nodiscard]] std::span<ContactPack> packs() { return {packs_.data(), first_points_.size()}; }
  [[nodiscard]] std::span<const ContactPack> packs() const { return {packs_.data(), first_points_.size()}; }
  [[nodiscard]] std::span<PackPoint> points() { return {points_.data(), point_count_}; }
  [[nodiscard]] std::span<const PackPoint> points() const { return {points_.data(), point_count_}; }
  /// Contact of each lane of each pack, or kNone.
  [[nodiscard]] const std::vector<std::uint32_t>& packed() const { return packed_; }
  /// First pack of each set, first set of each stage, and the ends (ContactDomains).
  [[nodiscard]] const std::vector<std::size_t>& sets() const { return sets_; }
  [[nodiscard]] const std::vector<std::size_t>& stages() const { return stages_; }
  /// First pack of each colour in each set, and the end.
  [[nodiscard]] const std::vector<std::size_t>& colours() const { return colours_; }
  /// One past the last point of the packs before this one.
  [[nodiscard]] std::size_t end_of_points(std::size_t pack) const {
    return pack < first_points_.size() ? first_points_[pack] : point_count_;
  }

 private:
  void colour(std::span<const std::uint32_t> set);
  void fill_last_packs();
  void lay_out(std::span<const std::uint32_t> list);
  [[nodiscard]] std::span<const std::uint32_t> lanes(std::size_t pack) const {
    return {packed_.data() + kLanes * pack, kLanes};
  }
  [[nodiscard]] bool share_a_body(std::size_t one, std::size_t other) const;

  std::span<SolverContact> contacts_;
  std::vector<ContactPack> packs_;  ///< as many as there were at most: they are begun anew
  std::vector<PackPoint> points_;   ///< the same
  std::size_t point_count_ = 0;
  std::vector<std::size_t> first_points_;  ///< of each pack
  std::vector<std::uint32_t> packed_;
  std::vector<std::size_t> sets_, stages_, colours_;
  std::vector<std::vector<std::uint32_t>> by_colour_;
  std::vector<std::uint64_t> used_;                        ///< of each body: its colours, a bit each, the first 64 ...
  std::map<int, std::vector<std::uint64_t>> used_beyond_;  ///< ... and those beyond, of the few that have more
};

}  // namespace topple::collision
