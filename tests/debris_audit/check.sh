#!/usr/bin/env bash
# check.sh SOURCE BUILD: the audit of ../shared/debris, built against the library of this build, runs a scene.
set -euo pipefail
source=$1 build=$2
audit=$source/../shared/debris/build-audit
[ -e "$audit" ] || { echo "SKIPPED: no ../shared/debris"; exit 0; }
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
TOPPLE=$source bash "$audit" "$build/collision" "$place/debris-audit" >"$place/log" 2>&1 || { cat "$place/log" >&2; exit 1; }
told=$("$place/debris-audit" s3_stack default)
grep -q "lost 0" <<<"$told" || { echo "$told" >&2; exit 1; }
