#!/bin/bash
# Sets up, builds, and shows what Loopwright does: a linear-motor loop simulated, and a model held against measurements.
# The pages end up in build/demo/.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
export LOOPWRIGHT_DATA=${LOOPWRIGHT_DATA:-$PWD/../shared/data}

tools/setup.sh
mkdir -p build/demo
echo 'Building (a few minutes the first time) …'
cmake --preset release >build/cmake_release.log 2>&1 || { cat build/cmake_release.log; exit 1; }
cmake --build --preset release --target loopwright >build/build_release.log 2>&1 || { tail -n 40 build/build_release.log; exit 1; }
loopwright=build/release/bin/loopwright

chapter() { printf '\n── %s\n' "$*"; }

chapter 'A linear motor under PD + feedforward + disturbance observer: cogging, encoder, 600 mm in 2.6 s'
$loopwright check diagrams/linear_motor/pd_dob.json
$loopwright run diagrams/linear_motor/pd_dob.json --report build/demo/stage.html -o build/demo/stage.csv

chapter 'The same loop with a payload that the controller does not know'
$loopwright run diagrams/linear_motor/pd_dob.json --variant stage=loaded --report build/demo/stage_loaded.html -o build/demo/stage_loaded.csv

pages=(build/demo/stage.html build/demo/stage_loaded.html)
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

chapter 'Open these pages in a browser:'
printf '  %s\n' "${pages[@]}"
