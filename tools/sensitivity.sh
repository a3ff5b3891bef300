#!/bin/bash
# Half and one and a half of each threshold of the diagnosis, on a few records: what answers change.
#   tools/sensitivity.sh     see --help; docs/hidden_effects.md has the table
# An interrupted run continues where it stopped.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

mkdir -p build
[ -f build/release/build.ninja ] || cmake --preset release >build/cmake_release.log 2>&1 || { cat build/cmake_release.log; exit 1; }
cmake --build build/release --target sensitivity conditions loopwright_lanes >build/build_release.log 2>&1 ||
  { tail -n 40 build/build_release.log; exit 1; }
exec /usr/bin/python3 tests/sensitivity/sensitivity.py --program build/release/bin/sensitivity --generator build/release/bin/conditions "$@"
