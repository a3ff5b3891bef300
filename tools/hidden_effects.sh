#!/bin/bash
# Evaluates the diagnosis: N plants with hidden effects, drawn at random, diagnosed blind, and compared with
# the truth.
#   tools/hidden_effects.sh 300 --seed-base 900000     see --help; docs/hidden_effects.md explains the table
# An interrupted batch continues where it stopped.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

mkdir -p build
[ -f build/release/build.ninja ] || cmake --preset release >build/cmake_release.log 2>&1 || { cat build/cmake_release.log; exit 1; }
cmake --build build/release --target loopwright loopwright_lanes hidden_effects >build/build_release.log 2>&1 ||
  { tail -n 40 build/build_release.log; exit 1; }
exec python3 tests/hidden_effects/judge.py --loopwright build/release/bin/loopwright --generator build/release/bin/hidden_effects "$@"
