#!/usr/bin/env bash
# viewer.sh PRESET: headless runs that use everything the viewer has; they fail when OpenGL reports an error, and under
# the sanitizers when something leaks.
set -euo pipefail
scripts/build "$1" topple-viewer
ctest --preset "$1" --output-on-failure -R '^viewer: a run that uses everything'
