#pragma once
// Capacities, gravity and the rules of failure, changed while the effect is seen; and the changed model as a file.
#include <array>
#include <string>

#include "app/controller.h"

namespace topple::viewer {

class TuningPanel {
 public:
  void draw(Controller& controller, const Snapshot& moment);

 private:
  [[nodiscard]] std::string selector(const Controller& controller) const;
  void capacities(Controller& controller, const Snapshot& moment);
  void gravity(Controller& controller);
  void rules(Controller& controller);
  void file(Controller& controller, const Snapshot& moment);
  int target_ = 0;
  std::array<char, 64> pattern_{};
  double gravity_ = -1;  ///< m/s2; below 0: not read yet
  void panels();
  void materials(Controller& controller);
  void restart(Controller& controller);
  [[nodiscard]] std::vector<structure::MaterialChange> changed_materials() const;
  std::optional<RunRules> rules_;
  std::vector<structure::MaterialChange> materials_;
  std::array<char, 256> file_{"tuned.json"};
};

/// Writes the scene's model with the changes of its capacities and strengths. Throws std::exception when it cannot.
void write_tuned_model(const Scene& scene, const Snapshot& moment, const std::string& file,
                       const std::vector<structure::MaterialChange>& materials = {});

}  // namespace topple::viewer
