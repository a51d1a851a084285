#!/usr/bin/env bash
# The window, end to end, on a screen that nobody sees: Xvfb, a driver that draws on the processor, keys and
# mouse by xdotool. What happened is read from the window's log and from the files that it wrote.
#
#   tests/window/run.sh PROGRAM [FOLDER]
#
# Needs Xvfb, xdotool and a Vulkan driver (Debian: xvfb xdotool libvulkan1 mesa-vulkan-drivers
# libxkbcommon-x11-0).
set -euo pipefail
program="$(realpath "$1")"
here="${2:-$(mktemp -d)}"
mkdir -p "$here"
cd "$here"
export DYELAPSE_SETTINGS="$here/settings.ron"

fail() { echo "window: $*" >&2; [ -f acts.log ] && cat acts.log >&2; exit 1; }
value() { sed -n "s/.*act=$1.* $2=\([^ ]*\).*/\1/p" acts.log | tail -1; }

# Without a display the program says so, and what to do instead.
set +e
said="$(env -u DISPLAY -u WAYLAND_DISPLAY "$program" watch one_drop 2>&1)"; code=$?
set -e
[ "$code" = 2 ] || fail "without a display the exit code is $code"
grep -q "dyelapse record" <<< "$said" || fail "without a display it says: $said"
set +e
said="$(env -u WAYLAND_DISPLAY DISPLAY=:250 "$program" watch one_drop 2>&1)"; code=$?
set -e
[ "$code" = 2 ] || fail "with a display that is not there the exit code is $code: $said"

# A screen.
screen=""
for n in $(seq 20 60); do
  [ -e "/tmp/.X$n-lock" ] && continue
  Xvfb ":$n" -screen 0 1280x800x24 -nolisten tcp >/dev/null 2>&1 &
  xvfb=$!
  trap 'kill $xvfb 2>/dev/null || true' EXIT
  sleep 1
  kill -0 "$xvfb" 2>/dev/null && { screen=":$n"; break; }
done
[ -n "$screen" ] || fail "no screen"
export DISPLAY="$screen"

watch() { rm -f acts.log; timeout "$1" "$program" watch "$2" --size 1280x800 --script "$3" --log acts.log 2>window.err; }

echo "= what is painted, creased and saved is what is recorded, byte for byte"
cat > one.ron <<'E2'
[
    Pause, GoTo(40), Arrive,
    Stroke(Dye, 0.05, [(0.2, 0.2), (0.8, 0.6)]), Arrive,
    Stroke(Resist, 0.04, [(0.2, 0.8), (0.8, 0.8)]), Arrive,
    Crease((0.5, 0.1), (0.5, 0.9)), Arrive,
    Overlay(Some(AllDye)), Cut((0.1, 0.5), (0.9, 0.5)), Wait(0.5),
    Save("painted.ron"),
    Record("from_window", 4, false), Recorded,
    Record("draped_window", 2, true), Recorded,
    Undo, Arrive, Undo, Arrive, Undo, Arrive,
    Screenshot("window.png"),
    Quit,
]
E2
watch 240 one_drop one.ron || fail "the first script did not end well"
[ "$(value 'Record(' problem)" = false ] || fail "recording began with a problem"
[ "$(value Screenshot edits)" = 6 ] || fail "three edits and three undone make $(value Screenshot edits)"
"$program" check painted.ron > /dev/null || fail "what was saved is not right"
grep -q "Strokes" painted.ron || fail "no strokes in what was saved"
grep -q "//" painted.ron || fail "no comments in what was saved"
"$program" record painted.ron --frames 4 --out from_file --quiet
for frame in from_file/frame_*.png; do
  cmp "$frame" "from_window/$(basename "$frame")" || fail "frames differ"
done
"$program" record painted.ron --frames 2 --view draped --out draped_file --quiet 2>/dev/null
for frame in draped_file/frame_*.png; do
  cmp "$frame" "draped_window/$(basename "$frame")" || fail "draped frames differ"
done
[ -s window.png ] || fail "no screenshot"

echo "= time goes forwards and backwards, and keeps its frames"
cat > two.ron <<'E2'
[
    Pause, GoTo(5000), Arrive, GoTo(100), Arrive, GoTo(3000), Arrive,
    GoTo(0), Arrive, PerFrame(1000), Play, Wait(3), Pause, Log("played"),
    View(Flat), Zoom(30, (0.25, 0.4)), Wait(1), Screenshot("yarns.png"),
    View(Draped), Wait(1), Screenshot("draped.png"), Quit,
]
E2
watch 240 seikaiha two.ron || fail "the second script did not end well"
grep -q "act=Wait(3.0) step=[1-9]" acts.log || fail "the process did not play"

echo "= keys and mouse"
cat > three.ron <<'E2'
[ Pause, GoTo(20), Arrive, Log("ready"), Wait(22), Pause, Wait(1), Quit ]
E2
watch 240 one_drop three.ron & window=$!
for _ in $(seq 100); do grep -qs "^ready" acts.log && break; sleep 0.3; done
id="$(xdotool search --name '^dyelapse$' | head -1)"
[ -n "$id" ] || fail "no window"
xdotool windowfocus "$id" 2>/dev/null || true
key() { xdotool key "$1"; sleep 0.8; }
# Paint on the flat cloth: to the right of the parameters, left of the draped one.
xdotool mousemove 520 330; sleep 0.8
key b
xdotool mousedown 1; sleep 0.5
for x in 530 545 560 580; do xdotool mousemove "$x" 345; sleep 0.4; done
xdotool mouseup 1; sleep 2
xdotool keydown ctrl; sleep 0.4; key z; xdotool keyup ctrl; sleep 0.4
key v
# Turn the draped cloth.
xdotool mousemove 1000 330; sleep 0.5; xdotool mousedown 1; sleep 0.4
for x in 1020 1060 1100; do xdotool mousemove "$x" 350; sleep 0.3; done
xdotool mouseup 1; sleep 0.3
key space
wait "$window" || fail "the third script did not end well"
[ "$(value 'Wait(22.0)' edits)" = 2 ] || fail "a stroke and its undoing make $(value 'Wait(22.0)' edits) edits"
[ "$(value 'Wait(22.0)' step)" -gt 20 ] || fail "the space bar did not play"

echo "= a file that changes is opened again, a mistake in it is told and the cloth stays"
cp painted.ron mine.ron
cat > four.ron <<'E2'
[ Pause, Wait(4), Screenshot("mistake.png"), Log("broken"), Wait(5), Log("mended"), Wait(1), Quit ]
E2
watch 240 mine.ron four.ron & window=$!
for _ in $(seq 100); do grep -qs "act=Pause" acts.log && break; sleep 0.2; done
sleep 1
sed 's/cloth: (/clot: (/' painted.ron > mine.ron
for _ in $(seq 100); do grep -qs "^broken" acts.log && break; sleep 0.2; done
sed 's/dose: 1/dose: 0.5/' painted.ron > mine.ron
wait "$window" || fail "the fourth script did not end well"
grep "act=Wait(4.0)" acts.log | grep -q "problem=true" || fail "the mistake was not told"
grep "act=Wait(5.0)" acts.log | grep -q "problem=false" || fail "the mended file was not opened again"

echo "= closing while it records leaves a valid recording"
cat > five.ron <<'E2'
[ Pause, Record("cut_short", 300, false), Wait(2), Quit ]
E2
watch 240 seikaiha five.ron || fail "the fifth script did not end well"
grep -q "complete: false" cut_short/recording.ron || fail "the recording says that it is whole"
for frame in $(sed -n 's/.*file: "\([^"]*\)".*/\1/p' cut_short/recording.ron); do
  [ -s "cut_short/$frame" ] || fail "$frame is told of and not there"
done
echo "= the window is well"
