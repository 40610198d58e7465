#pragma once
// The change from an old factor to a new one. The new one is made on another thread while the old one is in use. It is
// due when the answers since then have cost a share of its own work. Then it is brought up to the changes made
// meanwhile, a part beside each answer, and takes over.
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "assembly/frame_system.h"
#include "factor/factor.h"
#include "reanalysis/background_factor.h"
#include "reanalysis/base_factor.h"
#include "reanalysis/reanalysis_work.h"

namespace topple::solver {

class FactorRefresh {
 public:
  /// What a new factor was made of, and what serves with it.
  struct Made {
    std::unique_ptr<Factor> factor;
    std::unique_ptr<BaseFactor> base;
    double condition = 0;        ///< of the matrix that it was made of
    std::vector<double> values;  ///< of that matrix
  };

  void set_rules(RefreshRules rules) { rules_ = std::move(rules); }
  [[nodiscard]] const RefreshRules& rules() const { return rules_; }
  /// None is under way, and one may be made.
  [[nodiscard]] bool may_begin() const { return !base_ && allowed_; }
  /// Whether one may be made of what the factor in service was made of.
  void allow(bool allowed) { allowed_ = allowed; }
  /// Of the system's matrix as it is. `cost`: predicted, of a new factor. The system must outlive this.
  void begin(const FrameSystem& system, const std::vector<int>& order, const AnalysisOptions& options, double cost);
  /// The predicted cost of answers.
  void pay(double cost) { paid_ += cost; }
  /// Remembers what changes since it was begun; null when none is under way.
  [[nodiscard]] BaseFactor* base() const { return base_.get(); }
  /// When it is due it is waited for, and catches up by a part. True: it may take over.
  [[nodiscard]] bool go_on(ReanalysisWork& work);
  /// At once, whatever it has to catch up with. False: there is none under way, or it is of no use.
  [[nodiscard]] bool finish(ReanalysisWork& work);
  /// Hands over what was made.
  [[nodiscard]] Made release();
  /// The thread of one that is under way is waited for when the next one begins.
  void drop();

  // factor_archive.h. A factor that is under way is begun anew where it is loaded. What runs on the other thread before
  // it begins is not saved: the loaded one keeps its own.
  template <class Archive>
  void save(Archive& archive, const FrameSystem& system) const;
  template <class Archive>
  void load(Archive& archive, const FrameSystem& system, const std::vector<int>& order, const AnalysisOptions& options);

 private:
  [[nodiscard]] bool receive(ReanalysisWork& work);

  RefreshRules rules_;
  std::unique_ptr<BaseFactor> base_;            ///< that will serve
  std::unique_ptr<BackgroundFactor> making_;    ///< the factor that it is to serve with
  std::unique_ptr<BackgroundFactor> unwanted_;  ///< its result is not needed any more
  std::unique_ptr<Factor> factor_;              ///< what was made; base_ adds later changes to it
  std::vector<double> values_;                  ///< of the matrix that it was made of
  double condition_ = 0;
  double paid_ = 0, due_ = 0;  ///< cost of answers since it was begun; cost at which it is taken
  bool allowed_ = true;
};

}  // namespace topple::solver
