#!/bin/bash
# Sets up, builds, and demonstrates Loopwright: a linear-motor loop simulated, a hidden effect found and added, and a
# model compared with measurements. The pages are written to build/demo/.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
export LOOPWRIGHT_DATA=${LOOPWRIGHT_DATA:-$PWD/../shared/data}

tools/setup.sh
mkdir -p build/demo
echo 'Building (a few minutes the first time) …'
cmake --preset release >build/cmake_release.log 2>&1 || { cat build/cmake_release.log; exit 1; }
cmake --build --preset release --target loopwright loopwright_lanes hidden_effects hil_emulator >build/build_release.log 2>&1 || { tail -n 40 build/build_release.log; exit 1; }
loopwright=build/release/bin/loopwright

chapter() { printf '\n── %s\n' "$*"; }

chapter 'A linear motor under PD + feedforward + disturbance observer: cogging, encoder, 600 mm in 2.6 s'
$loopwright check diagrams/linear_motor/conventional.json
$loopwright run diagrams/linear_motor/conventional.json --report build/demo/stage.html -o build/demo/stage.csv

chapter 'The same loop with a payload that the controller does not know'
$loopwright run diagrams/linear_motor/conventional.json --set payload="0.2621 kg" --report build/demo/stage_loaded.html -o build/demo/stage_loaded.csv

pages=(build/demo/stage.html build/demo/stage_loaded.html)

chapter 'An axis that hides something. Its loop as believed, against a record:'
hidden=build/demo/hidden
build/release/bin/hidden_effects 21 $hidden paper coulomb_friction cogging
mv $hidden/truth.json build/demo/hidden_truth.json
$loopwright compare $hidden/nominal.json $hidden/closed_loop.experiment.json --report build/demo/hidden_before.html
chapter 'What is missing?'
$loopwright diagnose $hidden/nominal.json $hidden/train.experiment.json \
  --report build/demo/diagnosis.html --json build/demo/diagnosis.json -o $hidden/improved.json
chapter 'The improved loop, against the same record of another motion than it was diagnosed on:'
$loopwright compare $hidden/improved.json $hidden/closed_loop.experiment.json --report build/demo/hidden_after.html
echo 'What was hidden, by the generator that the diagnosis knows nothing of:'
grep '"effect"' build/demo/hidden_truth.json
pages+=(build/demo/hidden_before.html build/demo/diagnosis.html build/demo/hidden_after.html)

if [ -f "$LOOPWRIGHT_DATA/emps/emps_train.csv" ]; then
  for model in nominal published; do
    chapter "A measured positioning axis (EMPS), closed loop, against the $model model"
    $loopwright compare diagrams/emps/$model.json diagrams/emps/closed_loop.experiment.json \
      --report build/demo/emps_$model.html --json build/demo/emps_$model.json
    pages+=(build/demo/emps_$model.html)
  done
else
  chapter "No measurements below $LOOPWRIGHT_DATA: the comparison with the EMPS axis is left out"
fi

chapter 'Ten thousand runs of the loop: payload, cogging, pitch, friction, encoder and observer'
rm -rf build/demo/robustness
$loopwright sweep diagrams/linear_motor/robustness.sweep.json -o build/demo/robustness
$loopwright sweep report build/demo/robustness -o build/demo/robustness.html
pages+=(build/demo/robustness.html)

chapter 'Which controller is robust to what: conventional, DS, PS and beyond over payload, cogging and bandwidth'
rm -rf build/demo/controllers
$loopwright sweep diagrams/linear_motor/controllers.sweep.json -o build/demo/controllers
$loopwright sweep report build/demo/controllers -o build/demo/controllers.html
pages+=(build/demo/controllers.html)

chapter 'The axis that hides something, in the studio: run it, compare it with a record, find what is missing, add it:'
printf '  %s\n' "$loopwright studio $hidden/nominal.json"
chapter 'Open these pages in a browser:'
printf '  %s\n' "${pages[@]}"
