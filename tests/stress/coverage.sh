#!/usr/bin/env bash
# Lines of every reader that its tests and the fuzzers' corpora run: scripts/stress coverage [--lines] [--again]. A table of
# files; --lines names those that nothing runs. --again counts on from the last time. Status 1 below 95 % in sum.
set -euo pipefail
cd "$(dirname "$0")/../.."
shift  # the preset: this has one of its own

lines=() again=false
for option in "$@"; do
  case $option in
    --lines) lines=(--lines) ;;
    --again) again=true ;;
    *) echo "coverage: no option \"$option\"" >&2; exit 2 ;;
  esac
done
scripts/build coverage test_structure test_viewer topple topple-viewer
build=build/coverage
$again || find $build -name '*.gcda' -delete

# By the files that tests lie in: Catch2 tags each test with its file's name (-#).
readers=()
for file in tests/structure/formats/*_test.cpp tests/structure/study/*_test.cpp; do readers+=("[#$(basename "$file" .cpp)]"); done
readers+=("[#snapshot_test]" "[#section_cuts_test]" "[#trust_test]" "[#joint_tuning_test]")
$build/bin/test_structure -# "$(IFS=,; echo "${readers[*]}")"
$build/bin/test_viewer -# "a script*,[#start_page_test],[#open_scene_test]"
tests/analyse_command/run "$PWD/$build/bin/topple"
python3 tests/fracture_command/check.py $build/bin/topple
python3 tests/study/check.py $build/bin/topple
python3 tests/stress/hostile.py $build/bin --cases 300
python3 tests/stress/hostile.py $build/bin --only beside
python3 tests/coverage/table.py $build --least 95 "${lines[@]}"
