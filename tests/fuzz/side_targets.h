#pragma once
// Files that lie beside a model: studies and their journals, time histories, section cuts.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "fuzz/promised.h"
#include "study/study_value.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/motion.h"
#include "topple/structure/study/study.h"

namespace topple::fuzz {

/// The building that histories and cuts are read for.
inline const Building& bay() {
  static const Building building = read_model((folder() / "bay.json").string(), Purpose::analyse);
  return building;
}

/// A study is read; samples of what varies are drawn, not run.
inline void study(std::string_view text) {
  promised([&] {
    const Study study = parse_study(text, "t.json", folder().path());
    if (study.samples > 100 || study.optimise) return;
    const StudyTask task = study_task(study);
    for (std::uint64_t k = 0; k < std::min<std::uint64_t>(task.sampler.samples(), 100); ++k)
      for (const StudyValue& value : task.sampler.values(k))
        if (value.is_number() && !std::isfinite(value.number)) found("a sample that is no number");
  });
}

/// A line of a journal behind its checksum, which no mutation would hit: taken, it is written again and read to the
/// same.
inline void journal(std::string_view text) {
  static const StudyTask task = [] {
    Distribution d;
    d.low = 0;
    d.high = 1;
    StudyTask one;
    one.sampler = StudySampler({{"x", d}}, {}, Sampling::latin, 50, 11);
    one.outputs = {"square", "inverse"};
    one.fingerprint = 17;
    return one;
  }();
  const std::uint64_t check = study::fnv1a(text, study::fnv1a(study::hexadecimal(task.fingerprint)));
  const std::string line = std::string(text) + ",\"check\":\"" + study::hexadecimal(check) + "\"}";
  const std::optional<Sample> sample = read_journal_line(task, line);
  if (!sample) return;
  const std::string written = journal_line(task, *sample);
  const std::optional<Sample> again = read_journal_line(task, written);
  if (!again || journal_line(task, *again) != written) found("a line of a journal that does not come back");
}

inline void history(std::string_view text) {
  const std::string file = folder() / "history.csv";
  write_file(file, text);
  promised([&] {
    const TimeHistory history = read_time_history(file, bay());
    for (const TimeHistory::Series& series : history.series) {
      if (series.values.size() != history.times.size()) found("a history with a column of another length");
      for (const double value : series.values)
        if (!std::isfinite(value)) found("a history with what is no number");
    }
  });
}

inline void cuts(std::string_view text) {
  const std::string file = folder() / "cuts.json";
  write_file(file, text);
  promised([&] {
    for (const SectionCut& cut : read_section_cuts(file, bay())) {
      if (!cut.at.allFinite()) found("a cut at no place");
      if (!((cut.axes * cut.axes.transpose() - Mat3::Identity()).norm() < 1e-9)) found("a cut with no axes");
    }
  });
}

}  // namespace topple::fuzz
