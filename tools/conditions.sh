#!/bin/bash
# Evaluates the diagnosis under many conditions: N records of other machines, clocks, sensors, drives and diagrams,
# clean ones among them, diagnosed blind, and compared with the truth.
#   tools/conditions.sh 500 --seed-base 900000     see --help; docs/hidden_effects.md explains the tables
# An interrupted batch continues where it stopped.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

mkdir -p build
[ -f build/release/build.ninja ] || cmake --preset release >build/cmake_release.log 2>&1 || { cat build/cmake_release.log; exit 1; }
cmake --build build/release --target loopwright loopwright_lanes conditions >build/build_release.log 2>&1 ||
  { tail -n 40 build/build_release.log; exit 1; }
exec python3 tests/conditions/benchmark.py --loopwright build/release/bin/loopwright --generator build/release/bin/conditions "$@"
