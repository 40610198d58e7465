#pragma once
// What the tool in hand does where a person points.
#include <optional>
#include <string>

#include "app/driver.h"
#include "app/picking.h"
#include "app/tools/hand.h"
#include "renderer/camera.h"

namespace topple::viewer {

class ToolUse {
 public:
  /// `ground`: its height, m. All must outlive it.
  ToolUse(Driver& driver, const structure::Building& building, const Hand& hand, const Camera& camera, double ground)
      : driver_(driver), building_(building), hand_(hand), camera_(camera), ground_(ground) {}

  /// On a part of the building. Returns what a person is told; nothing where there is nothing to tell.
  [[nodiscard]] std::optional<std::string> on(const Pick& found) const;
  /// A projectile along the ray that meets the target, gravity allowed for; without one, what lies as far away as the
  /// camera looks.
  void fire(const Ray& ray, const std::optional<Pick>& target) const;

 private:
  [[nodiscard]] std::string remove_support(const Pick& found) const;
  [[nodiscard]] std::string swing(const Pick& found) const;
  [[nodiscard]] std::string burn(const Pick& found) const;
  [[nodiscard]] std::string explode(const Pick& found) const;
  [[nodiscard]] std::optional<std::string> pull(const Pick& found) const;

  Driver& driver_;
  const structure::Building& building_;
  const Hand& hand_;
  const Camera& camera_;
  double ground_;
};

}  // namespace topple::viewer
