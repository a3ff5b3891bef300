#!/bin/bash
# Generates the tables and figures of the linear-motor paper: sets up, builds, runs the identification experiment, trains,
# simulates, and writes build/paper/report.html and build/paper/tables.json.
#   tools/reproduce_paper.sh [--runs N]      N runs with different noise for every number (5)
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

tools/setup.sh
mkdir -p build/paper
echo 'Building (a few minutes the first time) …'
cmake --preset release >build/cmake_release.log 2>&1 || { cat build/cmake_release.log; exit 1; }
cmake --build --preset release --target reproduce_paper >build/build_release.log 2>&1 || { tail -n 40 build/build_release.log; exit 1; }
build/release/bin/reproduce_paper --output build/paper "$@"
