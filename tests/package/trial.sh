#!/bin/bash
# Installs the Debian package in a bare Debian 12 and works there as a new user, without the source tree.
#   tests/package/trial.sh PACKAGE.deb FOLDER
# Needs root and debootstrap; packages come from where this machine gets its own.
set -euo pipefail
package=$(realpath "$1")
root=$(realpath -m "$2")

if [ ! -f "$root/.bare" ]; then
  rm -rf "$root"
  mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | grep -v security | head -n 1)
  debootstrap --variant=minbase bookworm "$root" "$mirror" >"$root.log" 2>&1 || { tail -n 20 "$root.log"; exit 1; }
  cp -r /etc/apt/. "$root/etc/apt/"
  cp -r /usr/share/keyrings/. "$root/usr/share/keyrings/"
  touch "$root/.bare"
fi
trap 'umount "$root/proc"' EXIT
mount -t proc proc "$root/proc"
inside() { chroot "$root" /bin/bash -euc "$1"; }

cp "$package" "$root/tmp/loopwright.deb"
cp /etc/resolv.conf "$root/etc/resolv.conf"
inside 'export DEBIAN_FRONTEND=noninteractive
  apt-get update -qq
  apt-get install -y -qq --no-install-recommends /tmp/loopwright.deb python3 python3-numpy >/tmp/install.log 2>&1 || { tail -n 20 /tmp/install.log; exit 1; }'
inside 'cd /tmp && rm -rf axis && loopwright new axis --from linear_motor && cd axis
  loopwright run nominal.json --report run.html
  loopwright run machine.json -o measured.csv -q
  loopwright compare nominal.json trial.experiment.json
  loopwright diagnose nominal.json trial.experiment.json -o improved.json --json found.json
  grep -q coulomb_friction found.json && grep -q cogging found.json
  python3 -c "import loopwright; print(loopwright.load(\"improved.json\").run().status)"
  test -s run.html && test -s /usr/share/man/man1/loopwright.1 && bash -n /usr/share/bash-completion/completions/loopwright'
# The commands of the tutorial's page, on the installed diagrams.
inside 'rm -rf /tmp/tutorial && mkdir /tmp/tutorial && cd /tmp/tutorial && ln -s /usr/share/loopwright/diagrams
  sed -n "/^\`\`\`sh/,/^\`\`\`\$/{/^\`\`\`/d;p}" /usr/share/loopwright/docs/tutorial.md >commands.sh
  test "$(grep -c "^loopwright run" commands.sh)" -ge 9 && bash -eu commands.sh >commands.log 2>&1 || { tail -n 20 commands.log; exit 1; }'
echo "the package works in a bare Debian 12"
