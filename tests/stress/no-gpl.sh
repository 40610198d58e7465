#!/usr/bin/env bash
# Builds without CHOLMOD's GPL modules (TOPPLE_GPL=OFF) and runs every test of that build: scripts/stress no-gpl.
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/build no-gpl
exec ctest --preset no-gpl
