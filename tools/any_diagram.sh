#!/bin/bash
# Evaluates the diagnosis without roles: N records of twelve kinds of plants, clean ones among them, diagnosed blind, and compared with the
# truth.
#   tools/any_diagram.sh 240                        see --help; docs/diagnose.md explains the tables
# An interrupted batch continues where it stopped.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

mkdir -p build
[ -f build/release/build.ninja ] || cmake --preset release >build/cmake_release.log 2>&1 || { cat build/cmake_release.log; exit 1; }
cmake --build build/release --target loopwright loopwright_lanes >build/build_release.log 2>&1 || { tail -n 40 build/build_release.log; exit 1; }
exec /usr/bin/python3 tests/any_diagram/benchmark.py --loopwright build/release/bin/loopwright "$@"
