#!/bin/sh
# Real time on the emulated card:  real_time.sh [SECONDS] [FOLDER]     (default: 60 s, build/real_time)
# The card runs in a process of its own; another process keeps a core busy. First a complete run at 1 kHz: no row of its
# log may be lost. Then the same run killed by kill -9 halfway: the card's watchdog must have set the output, and the log
# must extend to the last second. Exit code 1 if one of these fails; the lateness of the loop is only reported.
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
seconds=${1:-60}
out=${2:-$here/build/real_time}
build=${LOOPWRIGHT_BUILD:-$here/build/release}
mkdir -p "$out"
out=$(cd "$out" && pwd)
cd "$here"
export HIL_LIBRARY=$build/lib/libhil_emulator.so
export HIL_EMU_SHARED=$out/world
rm -f "$out"/log.csv* "$out"/killed.csv* "$out"/to_card

# An ordinary kernel is sometimes late by milliseconds: the card buffers 100 samples, late commands are counted.
sed -e 's/"buffer": 2/"buffer": 100/' -e 's/"on_overrun": "fault"/"on_overrun": "count"/' \
  -e 's/"timeout": 0.01/"timeout": 0.2/' hw/devices/qpid_e.json > "$out/device.json"
echo '{"plant.cogging": 0, "plant.tilt": 0.2}' > "$out/card.json"   # the weight must be held: the output is never 0 V

mkfifo "$out/to_card"
"$build/bin/hil_emulator_daemon" "$HIL_EMU_SHARED" "$out/card.json" < "$out/to_card" > "$out/from_card" &
card=$!
exec 3> "$out/to_card"
(while :; do :; done) &
load=$!
trap 'kill $load 2> /dev/null; exec 3>&-; wait $card 2> /dev/null || true' EXIT
until grep -q ready "$out/from_card" 2> /dev/null; do sleep 0.05; done

ask() {   # an internal number of the card
  lines=$(wc -l < "$out/from_card")
  echo "get $1" >&3
  while [ "$(wc -l < "$out/from_card")" -le "$lines" ]; do sleep 0.01; done
  tail -n 1 "$out/from_card"
}
figure() { sed -n "s/^ *\"$1\": \([^,]*\),*$/\1/p" "$out/figures.json" | head -n 1; }
deploy() {
  exec "$build/bin/loopwright" deploy diagrams/linear_motor/conventional.json --variant stage=quanser \
    --set "stage.device=$out/device.json" --set "solver.stop=$seconds" --json "$out/figures.json" "$@"
}
failed=0
demand() { if [ "$2" -eq 1 ]; then echo "  + $1"; else echo "  - $1"; failed=1; fi; }

echo "== $seconds s at 1 kHz beside a busy core ($(nproc) cores, load $(cut -d' ' -f1 /proc/loadavg))"
(deploy -q -o "$out/log.csv")
rows=$(grep -vc '^#' "$out/log.csv")
rows=$((rows - 1))
echo "  rows $rows, lost samples $(figure lost_samples), dropped rows $(figure dropped_rows), overruns $(figure overruns), log delay $(figure log_delay_max_s) s"
sed -n '/"lateness_us"/,/}/p' "$out/figures.json" | tr -d '\n' | sed 's/  */ /g'; echo
demand "every period has its row" "$((rows == seconds * 1000 + 1))"
demand "no row of the log is dropped" "$(($(figure dropped_rows) == 0))"
demand "no sample is lost" "$(($(figure lost_samples) == 0))"
demand "outputs safe: $(figure outputs_safe)" "$([ "$(figure outputs_safe)" = '"confirmed"' ] && echo 1 || echo 0)"

echo "== the same, killed by kill -9 after $((seconds / 2)) s"
deploy -q -o "$out/killed.csv" &
program=$!
sleep $((seconds / 2))
kill -9 $program
samples=$(ask samples)
wait $program 2> /dev/null || true
sleep 0.5
demand "the watchdog has the output: $(ask dac.0) V" "$([ "$(ask dac.0)" = 0 ] && [ "$(ask watchdog.expired)" = 1 ] && echo 1 || echo 0)"
"$build/bin/loopwright" recover "$out/killed.csv.journal" -o "$out/killed.csv" | sed 's/^/  /'
kept=$(($(grep -vc '^#' "$out/killed.csv") - 1))
behind=$((samples - kept))
demand "the log ends $behind ms before the kill" "$((behind <= 1000))"
exit $failed
