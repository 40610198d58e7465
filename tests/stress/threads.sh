#!/usr/bin/env bash
# Threads under the thread sanitizer: scripts/stress threads. The factor on several threads, factors made in the background,
# equations that threads share, studies side by side, a simulation on a thread of its own (Pacer), the viewer's driver.
# What is not here: the drawing itself, as drivers of OpenGL are not built for it.
set -euo pipefail
cd "$(dirname "$0")/../.."
shift  # the preset: this has one of its own
export TSAN_OPTIONS="halt_on_error=1 second_deadlock_stack=1"
scripts/build thread test_solver_threads
build/thread/bin/test_solver_threads --durations yes
scripts/build thread test_structure_threads test_driver_threads
tests="[#pacer_test],[#journal_test],one thread and two come to the same bits,who looks at a collapse changes nothing of it*"
build/thread/bin/test_structure_threads -# "$tests,What breaks off leaves with its momentum*" --durations yes
build/thread/bin/test_driver_threads -# "~sixty pictures*" --durations yes
