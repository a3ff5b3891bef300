#!/bin/bash
# Sets up, builds and runs all tests: optimised, then under the address and undefined-behaviour sanitizers.
#   tools/test.sh            everything
#   tools/test.sh --quick    without the sanitizers
# Measured data is looked for in $LOOPWRIGHT_DATA (default ../shared/data); tests that need it say when it is absent.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

quick=
case ${1-} in
  '') ;;
  --quick) quick=1 ;;
  *) sed -n '2,5s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac

export LOOPWRIGHT_DATA=${LOOPWRIGHT_DATA:-$PWD/../shared/data}
jobs=$(nproc)

tools/setup.sh
run() {
  echo "== $1"
  cmake --preset "$1" >build/cmake_"$1".log 2>&1 || { cat build/cmake_"$1".log; exit 1; }
  cmake --build --preset "$1" -- -k 0
  ctest --preset "$1" --parallel "$jobs"
}
mkdir -p build
run release
[ -n "$quick" ] || run sanitize
