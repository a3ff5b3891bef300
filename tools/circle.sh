#!/bin/sh
# The whole cycle on the emulated card:  circle.sh [FOLDER]        (default: build/circle)
# Deploys on a motor that hides an effect, diagnoses from the log what the model lacks, corrects the model, trains a
# compensation on the same log, and deploys again. All results are written to FOLDER; see docs/hardware.md.
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$here/build/circle}
mkdir -p "$out"
out=$(cd "$out" && pwd)
cd "$here"
# If the caller gives no program and library: those of this tree, built if missing or outdated.
if [ -z "${LOOPWRIGHT_PROGRAM-}" ] || [ -z "${HIL_LIBRARY-}" ]; then
  tools/setup.sh
  [ -f build/release/build.ninja ] || cmake --preset release >build/cmake_release.log 2>&1 || { cat build/cmake_release.log; exit 1; }
  cmake --build build/release --target loopwright loopwright_lanes hil_emulator >build/build_release.log 2>&1 ||
    { tail -n 40 build/build_release.log; exit 1; }
fi
loopwright=${LOOPWRIGHT_PROGRAM:-$here/build/release/bin/loopwright}
export HIL_LIBRARY=${HIL_LIBRARY:-$here/build/release/lib/libhil_emulator.so}
for needed in "$loopwright" "$HIL_LIBRARY"; do
  [ -e "$needed" ] || { echo "circle: $needed is not there" >&2; exit 2; }
done
export HIL_EMU=$here/hw/emulator/hidden_friction.json
export LOOPWRIGHT_DATA=$out
device="--variant stage=quanser --set stage.device=$here/hw/devices/qpid_e_emulated.json"
motor=diagrams/linear_motor

say() { printf '\n== %s\n' "$*"; }
say "1  the identification run on the card"
$loopwright deploy $motor/identification.json $device -o "$out/identification.csv" --report "$out/identification.html"
$loopwright run $motor/identification.json $device --replay "$out/identification.csv"
say "2  where the model fails"
$loopwright compare $motor/identification.json diagrams/circle/deployed.experiment.json --json "$out/before.json" --report "$out/before.html"
say "3  what it lacks"
$loopwright diagnose $motor/identification.json diagrams/circle/deployed.experiment.json -o "$out/improved.json" \
  --json "$out/diagnosis.json" --report "$out/diagnosis.html"
say "4  the improved diagram against the same log, and let run"
$loopwright compare "$out/improved.json" diagrams/circle/deployed.experiment.json --json "$out/after.json" --report "$out/after.html"
$loopwright run "$out/improved.json" -o "$out/improved.csv" --report "$out/improved.html"
say "5  a compensation from the same log"
cp diagrams/circle/deployed.training.json "$out"
(cd "$out" && $loopwright gp train deployed.training.json --model learned.model.json --report learned.html)
say "6  the test motion without and with it"
$loopwright deploy $motor/conventional.json $device -o "$out/conventional.csv" --report "$out/conventional.html"
$loopwright deploy $motor/ps.json $device --set "model=$out/learned.model.json" --set "compensation.lead=2.6 ms" \
  -o "$out/compensated.csv" --report "$out/compensated.html"
# Root mean square of the column error.sum [m], in micrometers.
tracking_error() {
  awk -F, '/^#/ { next } !column { for (i = 1; i <= NF; ++i) if ($i ~ /^error.sum/) column = i; next }
           { sum += $column * $column; ++rows } END { printf "%.2f µm", 1e6 * sqrt(sum / rows) }' "$1"
}
say "tracking error, rms: $(tracking_error "$out/conventional.csv") without, $(tracking_error "$out/compensated.csv") with the compensation"
