#!/bin/sh
# Tries the Debian packages in a fresh, minimal Debian 12: try_deb.sh FOLDER_OF_PACKAGES [ROOT]
# Needs root and debootstrap. ROOT is a folder that does not exist yet, of some GB in the end; it is deleted again.
# Packages come from the mirror in MIRROR, or from Debian's own.
set -eu
packages=$(realpath "$1")
here=$(realpath "$(dirname "$0")")
root=${2:-$(mktemp -u)}
mirror=${MIRROR:-http://deb.debian.org/debian}
[ ! -e "$root" ] || { echo "$root exists already" >&2; exit 2; }
ls "$packages"/traceraft_*.deb "$packages"/traceraft-dev_*.deb >/dev/null

# Nothing that is mounted there is deleted.
clean_up() {
  for folder in proc sys; do
    ! mountpoint -q "$root/$folder" || umount "$root/$folder" || return
  done
  rm -rf --one-file-system "$root"
}
trap clean_up EXIT
trap 'exit 1' INT TERM

inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }
# Root alone may read the packages where they are, so that apt does, too.
install() {
  inside apt-get -qq -o APT::Sandbox::User=root install -y --no-install-recommends "$@" >"$root/log" 2>&1 ||
    { cat "$root/log"; exit 1; }
  inside apt-get clean
}
size() { du -xsm "$root" | cut -f 1; }
fail() { echo "FAILED: $*"; exit 1; }

echo "== a minimal Debian 12 (a minute)"
debootstrap --variant=minbase bookworm "$root" "$mirror" >/dev/null
mount -t proc proc "$root/proc"
mount -t sysfs -o ro sysfs "$root/sys"
cp /etc/resolv.conf "$root/etc/resolv.conf"
cp "$packages"/traceraft_*.deb "$root/traceraft.deb"
cp "$packages"/traceraft-dev_*.deb "$root/traceraft-dev.deb"
inside apt-get -qq update
bare=$(size)

echo "== the program, with what it depends on"
inside dpkg-deb --field /traceraft.deb Package Version Installed-Size Depends Recommends
install /traceraft.deb
echo "added by it and its dependencies: $(($(size) - bare)) MB"
inside traceraft --version
inside traceraft list | sed -n 1,5p
inside traceraft run --quiet --case two-rafts --cells 24 --epsilon 0.5 --t-end 1 --out /tmp/x
inside traceraft run --cells 24 --t-end 1 --out /tmp/y | tail -n 12
inside traceraft resume --quiet /tmp/x
inside traceraft report --quiet /tmp/x
inside traceraft data check /usr/share/doc/traceraft/verification/data/synthetic/guv-3to1 | sed -n 1,3p
for file in bash-completion/completions/traceraft zsh/vendor-completions/_traceraft \
  fish/vendor_completions.d/traceraft.fish man/man1/traceraft.1.gz doc/traceraft/copyright doc/traceraft/README.md; do
  [ -s "$root/usr/share/$file" ] || fail "/usr/share/$file is not there"
done

echo "== manual page and completions, with man-db and bash-completion"
install man-db bash-completion
inside man -w traceraft
inside man --warnings traceraft 2>&1 | grep -q 'traceraft - predicts' || fail "the manual page is not shown"
# What bash-completion loads by the name of the command, as Tab does.
# shellcheck disable=SC2016
inside bash -c '. /usr/share/bash-completion/bash_completion; _completion_loader traceraft
  COMP_WORDS=(traceraft ru) COMP_CWORD=1; _traceraft; echo "ru: ${COMPREPLY[*]}"
  COMP_WORDS=(traceraft run --integrator "") COMP_CWORD=3; _traceraft; echo "--integrator: ${COMPREPLY[*]}"'

echo "== a charts' program, a vesicle to turn and two ranks, with what is recommended"
install gnuplot-nox libjs-three openmpi-bin
inside traceraft report --quiet /tmp/x
grep -q 'id="viewer"' "$root/tmp/x/report.html" || fail "the page has no vesicle to turn"
grep -q '<svg' "$root/tmp/x/report.html" || fail "the page has no charts"
if inside dpkg-deb --field /traceraft.deb Depends | grep -q libtrilinos; then
  inside mpirun --allow-run-as-root --oversubscribe -np 2 traceraft run --quiet --linear-solver teko \
    --case two-rafts --cells 24 --epsilon 0.5 --t-end 0.1 --out /tmp/z || fail "two ranks"
fi

echo "== the libraries: somebody else's project"
before=$(size)
install /traceraft-dev.deb cmake g++ ninja-build
echo "added by libraries, compiler and what they depend on: $(($(size) - before)) MB"
cp -r "$here" "$root/tmp/project"
inside sh -ec 'cd /tmp; cmake -Wno-dev -G Ninja -S project -B build >/dev/null 2>&1; cmake --build build >/dev/null; build/consumer'

echo "== removal"
inside apt-get -qq remove -y traceraft >/dev/null 2>&1
for left in bin/traceraft share/doc/traceraft include/traceraft; do
  [ ! -e "$root/usr/$left" ] || fail "/usr/$left is left"
done
echo "all is well"
