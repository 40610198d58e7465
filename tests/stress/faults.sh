#!/usr/bin/env bash
# Fails every write, rename, fsync and allocation of the programs in turn: scripts/stress faults [--short] (faults/faults.py).
set -euo pipefail
cd "$(dirname "$0")/../.."
preset=$1
shift
scripts/build "$preset" topple topple-viewer
exec python3 tests/stress/faults/faults.py "build/$preset/bin" "$@"
