#!/usr/bin/env bash
# clang-tidy over the sources of the whole tree: scripts/stress tidy [FOLDER...]. Takes hours; a change is checked by scripts/tidy.
set -euo pipefail
cd "$(dirname "$0")/../.."
shift  # the preset: warnings are those of the release build
[ $# -gt 0 ] || set -- apps benchmarks collision examples fracture solver structure tests
mapfile -t files < <(find "$@" -name '*.cpp' | sort)
exec scripts/tidy "${files[@]}"
