#!/usr/bin/env bash
# viewer.sh PRESET [SECONDS]: headless runs that use everything the viewer has, then for so long what a person might do by chance; they
# fail when OpenGL reports an error, and under the sanitizers when something leaks.
set -euo pipefail
scripts/build "$1" topple-viewer
ctest --preset "$1" --output-on-failure -R '^viewer: a run that uses everything'
[ "${2:-0}" = 0 ] || python3 tests/viewer/random_use.py "build/$1/bin/topple-viewer" . "$2"
