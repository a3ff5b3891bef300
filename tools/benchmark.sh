#!/bin/bash
# Builds and runs the benchmarks: writes build/benchmarks.json and exits with 1 if a figure misses its limit. Ratios are
# measured in one process, alternating between both sides, so that other load affects them little. The most accurate
# figures still require an idle machine. Arguments go to Google Benchmark, for example --benchmark_filter=common_job.
set -euo pipefail

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
tools/setup.sh
[ -f build/release/build.ninja ] || cmake --preset release
cmake --build build/release --target benchmarks
code=0
build/release/bin/benchmarks build/benchmarks.json "$@" || code=$?
if [ $# -eq 0 ]; then
  cmake --build build/release --target loopwright hidden_effects
  LOOPWRIGHT=$root/build/release/bin/loopwright HIDDEN_EFFECTS=$root/build/release/bin/hidden_effects LOOPWRIGHT_SOURCE=$root \
    node tests/benchmarks/studio.mjs build/benchmarks.json || code=1
fi
exit $code
