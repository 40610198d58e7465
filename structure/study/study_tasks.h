#pragma once
// Tasks of studies of files.
#include <memory>
#include <vector>

#include "study/study_base.h"

namespace topple::structure::study {

/// make_base(), and what a sample would stumble over is told before the first. Throws InputError.
[[nodiscard]] std::shared_ptr<const StudyBase> sound_base(const Study& study, const std::vector<Variation>& variations);
/// Sets what a task has beside its sampler.
void complete_task(StudyTask& task, std::shared_ptr<const StudyBase> base);

}  // namespace topple::structure::study
