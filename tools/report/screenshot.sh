#!/bin/sh
# A picture of a report page:  screenshot.sh PAGE.html PICTURE.png [--dark] [--width PIXELS] [--height PIXELS]
# Without --height the whole page is taken. Needs chromium (Debian package chromium). Nothing is loaded from a network.
set -eu

usage() { sed -n '2s/^# //p' "$0" >&2; exit 2; }
[ $# -ge 2 ] || usage
page=$(realpath -- "$1") picture=$(realpath -m -- "$2")
[ -f "$page" ] || { echo "screenshot.sh: no such file: $1" >&2; exit 2; }
shift 2
width=1200 height='' dark=
while [ $# -gt 0 ]; do
  case $1 in
    --dark) dark=1; shift ;;
    --width) [ $# -ge 2 ] || usage; width=$2; shift 2 ;;
    --height) [ $# -ge 2 ] || usage; height=$2; shift 2 ;;
    *) usage ;;
  esac
done
command -v chromium >/dev/null || { echo 'screenshot.sh: chromium is not installed (Debian package chromium)' >&2; exit 1; }

profile=$(mktemp -d)
trap 'rm -rf -- "$profile"' EXIT INT TERM

browse() {
  timeout 60 chromium --headless --no-sandbox --disable-gpu --disable-background-networking --no-first-run \
    --hide-scrollbars --user-data-dir="$profile" ${dark:+--blink-settings=preferredColorScheme=0} \
    --virtual-time-budget=3000 "$@" "file://$page" 2>"$profile/log"
}

if [ -z "$height" ]; then
  # The page states its height in an attribute once it is drawn.
  height=$(browse --window-size="$width,900" --dump-dom | sed -n 's/.*<html[^>]* data-height="\([0-9]*\)".*/\1/p' | head -n 1)
  [ -n "$height" ] || { cat "$profile/log" >&2; exit 1; }
fi
browse --window-size="$width,$height" --screenshot="$picture"
[ -s "$picture" ] || { cat "$profile/log" >&2; exit 1; }
