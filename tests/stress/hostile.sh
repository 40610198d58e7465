#!/usr/bin/env bash
# Hostile inputs against the built programs: scripts/stress hostile [--cases N] [--only WORD] [--list] (hostile.py).
set -euo pipefail
cd "$(dirname "$0")/../.."
preset=$1
shift
scripts/build "$preset" topple topple-viewer
exec python3 tests/stress/hostile.py "build/$preset/bin" "$@"
