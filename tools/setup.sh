#!/bin/bash
# Prepares this machine to build Loopwright: installs the missing packages of tools/dependencies.txt, and the JavaScript
# packages of report pages, of the studio and of their tests. It may be run repeatedly: installed packages are left unchanged.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive

tools=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo --preserve-env=DEBIAN_FRONTEND)

say() { echo "setup: $*"; }
installed() { dpkg-query --show --showformat '${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed; }

# Node.js has many sources, some without a package npm: there the command decides, not the package.
present() {
  case $1 in
    nodejs) command -v node >/dev/null || installed nodejs ;;
    npm) command -v npm >/dev/null ;;
    *) installed "$1" ;;
  esac
}

install_packages() {
  local package missing=()
  while read -r package; do
    present "$package" || missing+=("$package")
  done < <(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$tools/dependencies.txt")
  [ ${#missing[@]} -gt 0 ] || return 0

  say "installing ${missing[*]}"
  local install=("${as_root[@]}" apt-get install -qq -y --no-install-recommends "${missing[@]}")
  # Package lists may be outdated or absent: they are fetched only if the first attempt fails.
  if ! "${install[@]}" >/dev/null 2>&1; then
    "${as_root[@]}" apt-get update -qq
    "${install[@]}" >/dev/null
  fi
}

# JavaScript packages into FOLDER/node_modules. A copy of the lock file beside the installed files shows whether the lock
# file has changed since.
install_scripts() {
  local folder=$1 stamp=$1/node_modules/.installed-lock
  ! cmp -s "$folder/package-lock.json" "$stamp" || return 0
  say "installing the JavaScript packages of $folder"
  (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >/dev/null)
  cp "$folder/package-lock.json" "$stamp"
}

install_packages
install_scripts "$tools/report"          # plots and layout of report pages
install_scripts "$tools/studio/web"      # the page of the studio
install_scripts "$tools/../tests/pages"  # drives chromium in tests
