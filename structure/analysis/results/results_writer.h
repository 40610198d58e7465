#pragma once
// What writes results.json: a list of pieces that are made side by side and handed on in order.
#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "formats/json/json_writer.h"
#include "topple/structure/results_selection.h"

namespace topple::structure {

/// A few characters that are copied so often that it has to take no call: all the room, whatever their number.
class ShortText {
 public:
  ShortText() = default;
  ShortText(std::string_view text) : size_(text.size()) {
    std::memcpy(text_.data(), text.data(), std::min(size_, room));
  }
  /// Writes on `room` characters from `at` on and returns the end of the text.
  char* put(char* at) const {
    std::memcpy(at, text_.data(), room);
    return at + size_;
  }
  static constexpr std::size_t room = 32;

 private:
  std::array<char, room> text_{};
  std::size_t size_ = 0;
};

/// Writes in the model's units: every quantity is divided by its factor to SI.
class ResultsWriter {
 public:
  ResultsWriter(const Building& building, const AnalysisRequest& request, const AnalysisResult& result,
                const std::map<std::string, double>& seconds);
  /// Of these members and nodes alone.
  void select(const ResultsSelection& selection);

  /// The header keys and what moves.
  [[nodiscard]] std::string diagnosis(const Diagnosis& diagnosis);
  /// All of it, handed on in pieces.
  void write(const std::function<void(std::string_view)>& sink);

 private:
  /// Names as keys and values, made once.
  struct Names {
    std::vector<std::string> nodes, members;
    ResultsSelection written;                  ///< all, when none are chosen
    std::vector<std::size_t> breakable;        ///< joints that have a use
    std::vector<std::string> combinations;     ///< of the result, as values
    std::array<ShortText, 8> diagrams;         ///< from behind the last one up to the first number
    std::array<ShortText, 6> node_components;  ///< the same of the envelope's displacements
  };
  using Piece = std::function<void(ResultsWriter&)>;

  /// For a piece, into the storage of an earlier text.
  ResultsWriter(const ResultsWriter& whole, std::string storage);

  std::vector<Piece> pieces() const;
  /// Items of a list or an object, some hundred of them to a piece.
  template <class Each>
  static void add_items(std::vector<Piece>& pieces, std::size_t count, Each each);

  /// In the model's units. Dividing by one takes as long as by anything else.
  [[nodiscard]] double in_units(double value, double factor) const { return si_ ? value : value / factor; }
  void header();
  [[nodiscard]] const char* p_delta() const;
  void design_header();
  template <class Values, class Factors>
  void list(const Values& values, const Factors& factors, int count);
  void node_displacement(std::size_t node, const Vec6& displacement);
  void reactions(const CombinationResult& c);
  void member(std::size_t m, const MemberResult& r, const DesignResult* used);
  void design(const DesignResult& used);
  void stations(const Member& member, const MemberResult& r);
  void largest_displacement(const LargestDisplacement& largest);
  void behind_members(const CombinationResult& c);
  void panel(const Panel& panel, const PanelResult& r, const CombinationResult& c);
  void mesh(const std::vector<int>& nodes, const CombinationResult& c);
  template <class Result>
  void resultants(const Result& r);
  void joint(const Joint& joint, const Utilisation& used);
  void cut(const SectionCut& cut, const CutResult& r);

  void member_envelope(std::size_t m);
  void joint_envelope();
  void node_envelope(std::size_t n);
  void losses();
  void loss_mechanism(const LossState& state);
  void loss_state(const LossState& state);
  void motion(const MotionResult& motion);
  void time_histories();
  void shape_of(const Vec6& motion);
  void shape(const std::vector<Vec6>& motion);
  void buckling();
  void modes();
  void seconds();

  const Building& b_;
  const AnalysisRequest& request_;
  const AnalysisResult& result_;
  const std::map<std::string, double>& seconds_;
  std::array<double, 6> force_, movement_;
  std::array<double, 8> diagram_;
  bool si_ = false;  ///< all of these are one
  std::shared_ptr<const Names> names_;
  JsonWriter w_;
};

/// Writes text behind `at` and returns its end.
inline char* put(std::string_view text, char* at) {
  return static_cast<char*>(std::memcpy(at, text.data(), text.size())) + text.size();
}

template <class Values, class Factors>
void ResultsWriter::list(const Values& values, const Factors& factors, int count) {
  w_.open('[');
  for (int i = 0; i < count; ++i) w_.value(in_units(values[i], factors[static_cast<std::size_t>(i) % factors.size()]));
  w_.close(']');
}

}  // namespace topple::structure
