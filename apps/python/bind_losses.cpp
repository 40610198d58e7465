// Losses of members, and motion through time.
#include <limits>

#include "bindings.h"
#include "results.h"

namespace topple::python {

using namespace structure;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

py::object name_or_none(const Building& building, JointId joint) {
  return joint.valid() ? py::object(py::str(building[joint].name)) : py::none();
}

/// First entries of pairs as indices, shape (pairs,).
template <class Pair>
Integers firsts(const std::vector<Pair>& pairs, const Owner& owner) {
  return field_of<Pair, std::int32_t>(
      pairs, [](const Pair& one) { return &one.first.index; }, owner);
}

void bind_verdict(py::class_<LossStateView>& state) {
  state
      .def_property_readonly(
          "combination", [](const LossStateView& s) { return s.building()[s.get().combination].name; },
          "Name of the combination.")
      .def_property_readonly(
          "stands", [](const LossStateView& s) { return s.get().stands(); },
          "True when what is left can bear the loads at all.")
      .def_property_readonly(
          "survives", [](const LossStateView& s) { return s.get().survives(); },
          "True when it stands and no joint is over its capacity.")
      .def_property_readonly(
          "mechanism", [](const LossStateView& s) { return s.get().mechanism; },
          "What moves, in words; \"\" when it stands.")
      .def_property_readonly(
          "moving_nodes", [](const LossStateView& s) { return firsts(s.get().motion, s.owner()); },
          "Indices of the nodes that move, most first, shape (moving,).")
      .def_property_readonly(
          "motion_shape",
          [](const LossStateView& s) {
            using Moved = std::pair<NodeId, Vec6>;
            return field_of<Moved, double>(s.get().motion, [](const Moved& one) { return one.second.data(); },
                                           s.owner(), {6}, {sizeof(double)});
          },
          "How they move, shape (moving, 6): x y z rx ry rz, global axes, largest translation 1.")
      .def_property_readonly(
          "loose", [](const LossStateView& s) { return names_of(s.building(), s.get().loose); },
          "Names of members that can move by themselves.")
      .def_property_readonly(
          "worst", [](const LossStateView& s) { return name_or_none(s.building(), s.get().worst); },
          "Name of the joint that is used most; None when no joint has a capacity.")
      .def_property_readonly(
          "utilisation", [](const LossStateView& s) { return s.get().utilisation.value; },
          "Of that joint, demand over capacity, 1 is the limit.")
      .def_property_readonly(
          "sense",
          [](const LossStateView& s) { return sense_names[static_cast<std::size_t>(s.get().utilisation.sense)]; },
          "The sense in which it is used most, one of topple.SENSES.");
}

/// The whole state, of a member that was named.
void bind_whole_state(py::class_<LossStateView>& state) {
  using Joints = std::pair<JointId, Utilisation>;
  using Ends = std::pair<MemberId, solver::Vec12>;
  state
      .def_property_readonly(
          "displacements", [](const LossStateView& s) { return rows_of(s.get().displacements, s.owner()); },
          "Of a member that was named in `lose` the displacements of the nodes, shape (nodes, 6), m and rad; else "
          "empty.")
      .def_property_readonly(
          "members", [](const LossStateView& s) { return firsts(s.get().end_forces, s.owner()); },
          "Of a named member the indices of the members that are left, shape (left,).")
      .def_property_readonly(
          "end_forces",
          [](const LossStateView& s) {
            return field_of<Ends, double>(s.get().end_forces, [](const Ends& one) { return one.second.data(); },
                                          s.owner(), {2, 6}, {6 * sizeof(double), sizeof(double)});
          },
          "Their end forces, shape (left, 2, 6): as CombinationResult.end_forces.")
      .def_property_readonly(
          "joints", [](const LossStateView& s) { return firsts(s.get().joints, s.owner()); },
          "Of a named member the indices of the joints with a capacity that are left, shape (joints left,).")
      .def_property_readonly(
          "utilisations",
          [](const LossStateView& s) {
            return field_of<Joints, double>(
                s.get().joints, [](const Joints& one) { return &one.second.value; }, s.owner());
          },
          "Their utilisations, shape (joints left,).")
      .def_property_readonly(
          "motion",
          [](const LossStateView& s) -> std::optional<MotionView> {
            if (!s.get().dynamic) return std::nullopt;
            return MotionView{s.analysis, &*s.get().dynamic};
          },
          "The loss through time (Motion), with analyse(..., dynamic=True); else None.");
}

void bind_loss_state(py::class_<LossStateView>& state) {
  bind_verdict(state);
  bind_whole_state(state);
}

/// Histories as one array: shape (times, things, numbers).
template <class Get>
Doubles history(const MotionView& m, std::size_t numbers, Get get) {
  const auto& samples = m.get().history;
  const std::size_t things = samples.empty() ? 0 : get(samples.front()).size();
  Doubles array(numbers == 1 ? std::vector<std::size_t>{samples.size(), things}
                             : std::vector<std::size_t>{samples.size(), things, numbers});
  double* out = array.mutable_data();
  for (const MotionSample& sample : samples) {
    const auto& values = get(sample);
    const auto* first = reinterpret_cast<const double*>(values.data());
    out = std::copy(first, first + numbers * things, out);
  }
  return array;
}

void bind_peaks(py::class_<MotionView>& motion) {
  motion
      .def_property_readonly(
          "joints",
          [](const MotionView& m) {
            return field_of<JointPeak, std::int32_t>(
                m.get().joints, [](const JointPeak& one) { return &one.joint.index; }, m.owner());
          },
          "Indices of the joints whose peaks follow, shape (joints,).")
      .def_property_readonly(
          "utilisations",
          [](const MotionView& m) {
            return field_of<JointPeak, double>(
                m.get().joints, [](const JointPeak& one) { return &one.utilisation.value; }, m.owner());
          },
          "Their largest utilisations, shape (joints,).")
      .def_property_readonly(
          "peak_demands",
          [](const MotionView& m) {
            return field_of<JointPeak, double>(m.get().joints, [](const JointPeak& one) { return one.demand.data(); },
                                               m.owner(), {6}, {sizeof(double)});
          },
          "What they bear then, shape (joints, 6): N and N m, local axes, tension positive in x.")
      .def_property_readonly(
          "peak_times",
          [](const MotionView& m) {
            return field_of<JointPeak, double>(
                m.get().joints, [](const JointPeak& one) { return &one.at; }, m.owner());
          },
          "When, shape (joints,), s.")
      .def_property_readonly(
          "amplifications",
          [](const MotionView& m) {
            std::vector<double> values;
            for (const JointPeak& peak : m.get().joints) values.push_back(peak.amplification.value_or(no_number));
            return copied<double>(values);
          },
          "Change of the governing demand to its peak over the change to the static state, shape (joints,); nan where "
          "that is small.")
      .def_property_readonly(
          "peak_displacements", [](const MotionView& m) { return rows_of(m.get().displacements, m.owner()); },
          "Greatest sizes of the nodes' displacements, shape (nodes, 6), component by component, m and rad.");
}

void bind_course(py::class_<MotionView>& motion) {
  motion
      .def_property_readonly(
          "period", [](const MotionView& m) { return m.get().period; }, "Lowest period, s.")
      .def_property_readonly(
          "damping", [](const MotionView& m) { return m.get().damping; },
          "Share of the critical damping at the lowest frequency.")
      .def_property_readonly(
          "duration", [](const MotionView& m) { return m.get().duration; }, "s.")
      .def_property_readonly(
          "substep", [](const MotionView& m) { return m.get().substep; }, "s.")
      .def_property_readonly(
          "change", [](const MotionView& m) { return m.get().change; },
          "By how much the last halving of the substep changed a peak at most, as a share.")
      .def_property_readonly(
          "times",
          [](const MotionView& m) {
            return field_of<MotionSample, double>(
                m.get().history, [](const MotionSample& s) { return &s.time; }, m.owner());
          },
          "Times of the history, shape (times,), s.")
      .def_property_readonly(
          "history_displacements",
          [](const MotionView& m) {
            return history(
                m, 6, [](const MotionSample& s) -> auto& { return s.displacements; });
          },
          "Of the nodes named in `history`, shape (times, nodes named, 6): m and rad. A new array.")
      .def_property_readonly(
          "history_demands",
          [](const MotionView& m) {
            return history(
                m, 6, [](const MotionSample& s) -> auto& { return s.demands; });
          },
          "Of the joints named in `history`, shape (times, joints named, 6): N and N m, local axes. A new array.")
      .def_property_readonly(
          "history_utilisations",
          [](const MotionView& m) {
            return history(
                m, 1, [](const MotionSample& s) -> auto& { return s.uses; });
          },
          "Of the joints named in `history`, shape (times, joints named). A new array.")
      .def_property_readonly(
          "history_nodes",
          [](const MotionView& m) { return names_of(m.building(), m.analysis->request.losses.motion.nodes); },
          "Names of those nodes.")
      .def_property_readonly(
          "history_joints",
          [](const MotionView& m) { return names_of(m.building(), m.analysis->request.losses.motion.joints); },
          "Names of those joints.")
      .def(
          "plot",
          [](const py::object& self, const py::args& args, const py::kwargs& options) {
            return py::module_::import("topple.plot").attr("history")(self, *args, **options);
          },
          "Draws the histories: topple.plot.history(motion, ...).");
}

}  // namespace

void bind_losses(py::module_& module) {
  py::class_<LossStateView> state(
      module, "LossState",
      "The state after a loss under one combination, before anything else breaks: the dynamic "
      "peak R0 + f (R1 - R0), f = `sudden`.");
  bind_loss_state(state);
  py::class_<LossView>(module, "Loss", "What the sudden loss of one member does.")
      .def_property_readonly(
          "member", [](const LossView& l) { return l.building()[l.get().member].name; },
          "Name of the member that is lost.")
      .def_property_readonly(
          "states", [](const LossView& l) { return parts_of<LossState>(l.analysis, l.get().states); },
          "A LossState for each combination.")
      .def_property_readonly(
          "survives",
          [](const LossView& l) {
            return std::all_of(l.get().states.begin(), l.get().states.end(),
                               [](const LossState& one) { return one.survives(); });
          },
          "True when it stands under every combination with no joint over its capacity.")
      .def_property_readonly(
          "utilisation",
          [](const LossView& l) {
            double largest = 0;
            for (const LossState& one : l.get().states)
              largest =
                  std::max(largest, one.stands() ? one.utilisation.value : std::numeric_limits<double>::infinity());
            return largest;
          },
          "The largest utilisation of all states; inf for a mechanism.");
}

void bind_motion(py::module_& module) {
  py::class_<MotionView> motion(module, "Motion",
                                "How the building moves after a loss, or under a time history (docs/dynamics.md).");
  bind_course(motion);
  bind_peaks(motion);
}

}  // namespace topple::python
