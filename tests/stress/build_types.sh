#!/usr/bin/env bash
# build_types.sh PRESET: collapses in a build without optimisation come to the bits of the release build. The preset is
# not looked at: both builds are made.
set -euo pipefail
scripts/build release topple
scripts/build unoptimised topple
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
status=0
for scenario in seed_hit house_hit wall_hit bridge_hit; do
  for preset in release unoptimised; do
    python3 -c '
import json, sys
scenario = json.load(open(sys.argv[1]))
scenario["duration"] = 3
json.dump(scenario, open(sys.argv[2], "w"))' "models/scenarios/$scenario.json" "$folder/$scenario.json"
    TOPPLE_MODELS="$PWD/models" "build/$preset/bin/topple" demolish "$folder/$scenario.json" -o "$folder/$preset" >/dev/null
    python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["hash"])' "$folder/$preset/summary.json" \
      >"$folder/$preset.hash"
  done
  if cmp -s "$folder/release.hash" "$folder/unoptimised.hash"; then
    echo "build_types: $scenario $(cat "$folder/release.hash") in both"
  else
    echo "build_types: $scenario differs: $(cat "$folder/release.hash") release, $(cat "$folder/unoptimised.hash") without optimisation" >&2
    status=1
  fi
done
exit $status
