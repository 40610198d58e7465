#pragma once
// What all samples of a study of a model or scenario share: the files as they stand, and what each variable changes.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/varied_document.h"
#include "topple/structure/building.h"
#include "topple/structure/scenario.h"

namespace topple::structure::study {

/// What one entry of `vary` or `choose` changes; its variables stand one after the other.
struct Effect {
  Variation variation;
  std::size_t first = 0, count = 0;
  /// joints: those of each variable; charges: the members of each time; loss: all members.
  std::vector<std::vector<std::string>> names;
};

struct StudyBase {
  Study study;
  std::string model_text, scenario_text;
  std::vector<Effect> effects;
  std::vector<StudyVariable> variables;
  std::vector<CorrelatedGroup> groups;

  [[nodiscard]] const Effect* effect(std::string_view name) const;
};

/// Reads the files and resolves names in the building as it stands. Throws InputError.
[[nodiscard]] std::shared_ptr<const StudyBase> make_base(const Study& study, const std::vector<Variation>& variations);

/// The building and scenario of one sample; reads again only what the sample changes.
class BaseOfSample {
 public:
  explicit BaseOfSample(std::shared_ptr<const StudyBase> base);
  /// After the inputs (one for each variable of the base). The scenario is there if the base is one.
  void apply(const std::vector<StudyValue>& inputs);
  [[nodiscard]] const Building& building() const { return building_; }
  [[nodiscard]] Building& building() { return building_; }
  [[nodiscard]] Scenario& scenario() { return scenario_; }
  /// All samples have the same names in the same places, and the same groups.
  [[nodiscard]] bool same_names() const { return same_names_; }
  /// The building is as it was in the sample before, whatever either loses.
  [[nodiscard]] bool same_building() const { return same_building_; }
  /// Members that the sample loses, and those that any sample of such a building may lose.
  [[nodiscard]] const std::vector<MemberId>& lost() const { return lost_; }
  [[nodiscard]] std::vector<MemberId> may_be_lost() const;
  /// Charges that go off.
  [[nodiscard]] int charges() const { return charges_; }

 private:
  [[nodiscard]] std::vector<std::string> beside_losses(const std::vector<StudyValue>& inputs) const;
  void read(const std::vector<StudyValue>& inputs);
  void strengthen(const Effect& effect, const std::vector<StudyValue>& inputs);
  void lose(const Effect& effect, const StudyValue& name);
  void charge(const Effect& effect, const std::vector<StudyValue>& inputs);
  [[nodiscard]] std::vector<MemberId> pieces_of(const std::string& member) const;

  std::shared_ptr<const StudyBase> base_;
  VariedDocument model_;
  std::unique_ptr<VariedDocument> scenario_document_;
  std::vector<std::size_t> model_targets_, scenario_targets_;  ///< variables
  Building as_read_;                                           ///< where no sample changes the model
  Building building_;
  Scenario scenario_;
  std::unique_ptr<NameIndex> names_;
  bool same_names_ = false, same_building_ = false;
  std::optional<std::vector<std::string>> applied_;  ///< what the building is made with, as text
  std::vector<MemberId> lost_;
  int charges_ = 0;
};

}  // namespace topple::structure::study
