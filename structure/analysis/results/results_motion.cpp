// What results.json and tables say of motions.
#include <charconv>

#include "analysis/results/output_units.h"
#include "analysis/results/results_writer.h"
#include "model/index_of.h"

namespace topple::structure {

void ResultsWriter::motion(const MotionResult& motion) {
  w_.key("dynamic").open('{').key("period").value(motion.period).key("shape_frequency").value(motion.shape_frequency);
  w_.key("damping").value(motion.damping).key("duration").value(motion.duration).key("substep").value(motion.substep);
  w_.key("halvings").value(static_cast<std::size_t>(motion.halvings)).key("change").value(motion.change);
  if (motion.unsettled > 0) w_.key("unsettled").value(static_cast<std::size_t>(motion.unsettled));
  w_.key("joints").open('{');
  for (const JointPeak& joint : motion.joints) {
    w_.newline()
        .key(b_[joint.joint].name)
        .open('{')
        .key("peak")
        .open('{')
        .key("utilisation")
        .value(joint.utilisation.value);
    w_.key("governing").value(sense_names[static_cast<std::size_t>(joint.utilisation.sense)]);
    w_.key("at").value(joint.at).close('}');
    if (joint.amplification) w_.key("amplification").value(*joint.amplification);
    w_.close('}');
  }
  w_.close('}').key("members").open('{');
  for (const MemberMotion& member : motion.members) {
    w_.newline().key(b_[member.member].name).open('{');
    for (std::size_t c = 0; c < 6; ++c) {
      const auto bound = [&](const char* name, const InTime& extreme) {
        w_.key(name).open('[').value(in_units(extreme.value, force_[c])).value(extreme.at).close(']');
      };
      w_.key(diagram_names[c]).open('{');
      bound("min", member.min[c]);
      bound("max", member.max[c]);
      w_.close('}');
    }
    w_.close('}');
  }
  w_.close('}').key("displacements").open('{');
  for (std::size_t n = 0; n < motion.displacements.size(); ++n) {
    w_.raw_key(names_->nodes[n]);
    list(motion.displacements[n], movement_, 6);
  }
  w_.close('}').close('}');
}

void ResultsWriter::time_histories() {
  w_.key("time_history").open('{');
  for (const auto& [combination, motion] : result_.motions) {
    w_.newline().key(b_[combination].name).open('{');
    this->motion(motion);
    w_.close('}');
  }
  w_.close('}').newline();
}

namespace {

/// Columns: combination, time, six of each node's displacement, six of each joint's demand and its use.
class HistoryTable {
 public:
  HistoryTable(const Building& building, const MotionRequest& request) : building_(building), units_(building.units) {
    const bool plain = building.units.consistent;
    const std::string length = plain ? "" : " (" + building.units.length_name + ")";
    const std::string force = plain ? "" : " (" + building.units.force_name + ")";
    const std::string moment = plain ? "" : " (" + building.units.force_name + " " + building.units.length_name + ")";
    text_ = "combination,time (s)";
    for (const NodeId node : request.nodes)
      for (std::size_t c = 0; c < 6; ++c)
        column(building[node].name + " " + component_names[c] + (c < 3 ? length : plain ? "" : " (rad)"));
    // Edges of panels bear by length.
    for (const JointId joint : request.joints) {
      const bool edge = building[joint].panel.valid();
      for (std::size_t c = 0; c < 6; ++c)
        column(building[joint].name + " " + component_names[c] +
               (edge    ? per_length(building, c)
                : c < 3 ? force
                        : moment));
      column(building[joint].name + " utilisation");
      edges_.push_back(edge);
    }
    text_ += '\n';
  }

  void add(CombinationId combination, const MotionResult& motion) {
    for (const MotionSample& sample : motion.history) {
      text(building_[combination].name);
      number(sample.time);
      for (const Vec6& u : sample.displacements)
        for (const double value : units_.movement(u)) number(value);
      for (std::size_t k = 0; k < sample.demands.size(); ++k) {
        const double length = edges_[k] ? building_.units.length : 1;
        for (const double value : units_.load(sample.demands[k])) number(value * length);
        number(sample.uses[k]);
      }
      text_.back() = '\n';
    }
  }

  [[nodiscard]] std::string release() { return std::move(text_); }

 private:
  static std::string per_length(const Building& building, std::size_t component) {
    if (building.units.consistent) return "";
    const Units& u = building.units;
    return component < 3 ? " (" + u.force_name + "/" + u.length_name + ")" : " (" + u.force_name + ")";
  }
  void text(const std::string& value) {
    const bool plain = value.find_first_of(",\"\n\r") == std::string::npos;
    if (plain) {
      text_ += value;
    } else {
      text_ += '"';
      for (const char c : value) text_ += c == '"' ? std::string("\"\"") : std::string(1, c);
      text_ += '"';
    }
    text_ += ',';
  }
  void column(const std::string& name) {
    text_ += ',';
    text(name);
    text_.pop_back();
  }
  void number(double value) {
    char digits[32];
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, value == 0 ? 0.0 : value).ptr);
    text_ += ',';
  }

  const Building& building_;
  OutputUnits units_;
  std::vector<char> edges_;
  std::string text_;
};

std::string history_file_name(const std::string& name) {
  std::string safe = name;
  for (char& c : safe)
    if (c == '/' || c == '\\' || c == ':') c = '_';
  return "history-" + safe + ".csv";
}

}  // namespace

NamedTexts motion_csv(const Building& building, const AnalysisRequest& request, const AnalysisResult& result) {
  NamedTexts files;
  const MotionRequest& wanted = request.losses.motion;
  if (wanted.nodes.empty() && wanted.joints.empty()) return files;
  for (const MemberLoss& loss : result.losses.losses) {
    HistoryTable table(building, wanted);
    bool any = false;
    for (const LossState& state : loss.states) {
      if (!state.dynamic) continue;
      table.add(state.combination, *state.dynamic);
      any = true;
    }
    if (any) files.emplace_back(history_file_name(building[loss.member].name), table.release());
  }
  if (result.motions.empty()) return files;
  HistoryTable table(building, wanted);
  for (const auto& [combination, motion] : result.motions) table.add(combination, motion);
  files.emplace_back("history-time-history.csv", table.release());
  return files;
}

}  // namespace topple::structure
