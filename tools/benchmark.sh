#!/bin/bash
# Builds the benchmarks and runs them: writes build/benchmarks.json and ends with 1 when a figure misses its bar.
# Ratios are measured in one process with both sides in turn, so that a busy machine disturbs them little; still, a quiet
# one gives the true figures. Arguments go to Google Benchmark, for example --benchmark_filter=common_job.
set -euo pipefail

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
tools/setup.sh
[ -f build/release/build.ninja ] || cmake --preset release
cmake --build build/release --target benchmarks
exec build/release/bin/benchmarks build/benchmarks.json "$@"
