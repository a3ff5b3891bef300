#!/bin/bash
# Sets up, builds and runs all tests: optimized, then the tests of file readers and hardware under sanitizers.
#   tools/test.sh                everything but the judgements
#   tools/test.sh --quick        without the sanitizers
#   tools/test.sh --judgements   with the tests that take half a minute or more each
# Prints the time of each part at the end. Measured data is searched in $LOOPWRIGHT_DATA (default ../shared/data); tests
# that need it report when it is absent.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

quick=
case ${1-} in
  '') ;;
  --quick) quick=1 ;;
  --judgements) export LOOPWRIGHT_JUDGEMENTS=1 ;;
  *) sed -n '2,7s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac

export LOOPWRIGHT_DATA=${LOOPWRIGHT_DATA:-$PWD/../shared/data}
jobs=$(nproc)
times=()

# Description, then the command, timed.
timed() {
  local name=$1 begin=$SECONDS code=0
  shift
  "$@" || code=$?
  times+=("$(printf '%7d s  %s' $((SECONDS - begin)) "$name")")
  return $code
}
say_times() {
  echo "== where the time went, $jobs processors"
  printf '%s\n' "${times[@]}"
  for preset in release sanitize; do
    [ -d "build/$preset/test_times" ] || continue
    echo "-- the longest tests of $preset"
    python3 tests/slowest.py "build/$preset"
  done
}
trap say_times EXIT

configure() { cmake --preset "$1" >build/cmake_"$1".log 2>&1 || { cat build/cmake_"$1".log; return 1; }; }
run() {
  echo "== $1"
  timed "configure $1" configure "$1"
  timed "build $1" cmake --build --preset "$1" -- -k 0
  rm -rf "build/$1/test_times"
  timed "test $1" ctest --preset "$1" --parallel "$jobs"
}
timed "set up" tools/setup.sh
mkdir -p build
run release
[ -n "$quick" ] || run sanitize
