#!/usr/bin/env bash
# Coverage-guided fuzzing of every reader and of sequences of calls: scripts/stress fuzz [TARGET...] [--minutes N] [--merge]
# [--built].
# Each target (all of them without one) runs for N minutes (5) from its corpus, tests/fuzz/corpus/TARGET, under the address
# and undefined-behaviour sanitizers. What is new is kept in build/fuzz/found/TARGET; --merge takes what adds coverage into
# the corpus; --built runs the programs as they stand. Inputs that end a run are left in build/fuzz/crashes. build/fuzz/runs.csv has a line for each run: when it
# ended, commit, target, seconds of a processor, executions, edges covered, status (0: nothing found).
set -euo pipefail
cd "$(dirname "$0")/../.."
shift  # the preset: fuzzers have one of their own

minutes=5 merge=false built=false targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --minutes) minutes=$2; shift 2 ;;
    --merge) merge=true; shift ;;
    --built) built=true; shift ;;
    -*) echo "fuzz: no option \"$1\"" >&2; exit 2 ;;
    *) targets+=("$1"); shift ;;
  esac
done
[ ${#targets[@]} -gt 0 ] || for corpus in tests/fuzz/corpus/*/; do targets+=("$(basename "$corpus")"); done
command -v clang++-19 >/dev/null || { echo "fuzz: needs clang-19 and libclang-rt-19-dev" >&2; exit 2; }

for target in "${targets[@]}"; do
  [ -d "tests/fuzz/corpus/$target" ] || { echo "fuzz: no target \"$target\"" >&2; exit 2; }
  $built || scripts/build fuzz "fuzz_$target"
done
mkdir -p build/fuzz/crashes
status=0
for target in "${targets[@]}"; do
  mkdir -p "build/fuzz/found/$target"
  echo "fuzz: $target, $minutes minutes"
  # A model may ask for much work within the limits: only what takes two minutes by the
  # clock of a busy machine is a finding.
  found=0
  TIMEFORMAT='%U %S'
  { time "build/fuzz/bin/fuzz_$target" "build/fuzz/found/$target" "tests/fuzz/corpus/$target" \
      -max_total_time=$((minutes * 60)) -timeout=120 -rss_limit_mb=4096 -max_len=20000 -print_final_stats=1 -verbosity=1 \
      "-artifact_prefix=build/fuzz/crashes/$target-" 2>"build/fuzz/$target.log" || found=$?; } 2>build/fuzz/times
  if [ $found -ne 0 ]; then
    status=1
    echo "fuzz: $target found something: build/fuzz/$target.log" >&2
  fi
  log() { grep -oE "$1[0-9]+" "build/fuzz/$target.log" | tail -1 | grep -oE "[0-9]+$" || echo 0; }
  echo "$(date -u +%FT%TZ),$(git describe --always --dirty),$target,$(awk '{print $1 + $2}' build/fuzz/times),$(log 'units: +'),$(log 'cov: '),$found" |
    tee -a build/fuzz/runs.csv
  grep SUMMARY "build/fuzz/$target.log" || true
  if $merge; then "build/fuzz/bin/fuzz_$target" -merge=1 "tests/fuzz/corpus/$target" "build/fuzz/found/$target"; fi
done
exit $status
