#!/usr/bin/env bash
# What a person does in the window, by xdotool on a display of its own: drive_window.sh VIEWER FOLDER
# Leaves in FOLDER: start.png, orbited.png, picked.png, hit.png, scrubbed.png, paused1.png, paused2.png. Status 77: a tool is missing.
set -eu
viewer=$1 folder=$2
command -v Xvfb >/dev/null && command -v xdotool >/dev/null || exit 77
mkdir -p "$folder"
cd "$folder"
Xvfb -displayfd 3 -screen 0 1000x700x24 -nolisten tcp 3>display 2>xvfb.log &
server=$!
trap 'kill $program $server 2>/dev/null || true' EXIT
program=
for _ in $(seq 100); do [ -s display ] && break; sleep 0.1; done
export DISPLAY=:$(cat display)
"$viewer" seed_building --show joints --size 900x600 --screenshot "$folder/shot.png" >viewer.log 2>&1 &
program=$!
xdotool search --sync --onlyvisible --name Topple >/dev/null
# A picture is there when its file has stopped growing.
picture() {
  rm -f shot.png
  xdotool key p
  for _ in $(seq 300); do [ -s shot.png ] && break; sleep 0.1; done
  local size=0
  while [ "$size" != "$(stat -c %s shot.png)" ]; do size=$(stat -c %s shot.png); sleep 0.3; done
  mv shot.png "$1"
}
xdotool mousemove 250 300
sleep 2
begun=$SECONDS
picture start.png
busy=$((SECONDS - begun))  # a busy machine simulates as slowly as it draws
xdotool mousedown 1
for x in 270 290 310; do xdotool mousemove "$x" 300; sleep 1.5; done
xdotool mouseup 1
sleep 1
picture orbited.png
# The tool that selects; then the one that fires again.
xdotool key v
xdotool mousemove 250 300 click 1
sleep 1
picture picked.png
xdotool key g
xdotool click 1
sleep $((6 + (busy < 10 ? 6 * busy : 60)))
picture hit.png
# The slider of time (panels: 25 texts of 14 pixels wide, 6.2 high; a picture may take a second without a graphics card) dragged to the beginning; Y returns to the present.
xdotool mousemove 500 558 mousedown 1
for x in 300 100 14; do xdotool mousemove "$x" 558; sleep $((2 + busy)); done
xdotool mouseup 1
sleep $((1 + busy))
picture scrubbed.png
xdotool key y key space
xdotool mousemove 250 300
sleep 1
# A shot in flight stands still while paused.
xdotool click 1
xdotool key space
# Where a picture takes a second, keys wait for some of them.
sleep 5
picture paused1.png
sleep 1
picture paused2.png
kill -0 $program
