# Shared by ./run and ./check: installs what is missing, configures and builds. Sourced, not run.
# Usage: prepare PRESET YES TARGET        (YES=1: install without asking; TARGET: traceraft or all)

packages="g++ cmake ninja-build libeigen3-dev libsuitesparse-dev libmetis-dev libopenblas-dev
libsundials-dev libcli11-dev nlohmann-json3-dev libtomlplusplus-dev libmuparser-dev zlib1g-dev libpng-dev libgif-dev libcsv-dev libnlopt-dev libsodium-dev
libgtest-dev gnuplot-nox libjs-three"
# For runs on several ranks: the program is complete without them. ./check needs them for its tests.
rank_packages="libopenmpi-dev openmpi-bin trilinos-all-dev"
# To see pages as readers do: ./check alone needs them.
browser_packages="chromium chromium-driver curl"
# To read the manual page and the completions as they do.
manual_packages="groff-base bash zsh fish"

say() { printf '%s\n' "$*" >&2; }

missing_packages() {
  for package in $packages; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
      printf '%s ' "$package"
  done
}

install_missing() {
  missing=$(missing_packages)
  [ -z "$missing" ] && return 0
  say "Debian packages to install: $missing"
  as_root=
  if [ "$(id -u)" -ne 0 ]; then
    as_root=sudo
    if [ "$1" != 1 ]; then
      printf 'Install them now with sudo apt-get? [y/N] ' >&2
      read -r answer || answer=
      case "$answer" in y | Y | yes) ;; *) say "Not installed. Again with --yes, or install them yourself."; return 1 ;; esac
    fi
  fi
  $as_root apt-get update -qq &&
    DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $missing >/dev/null
}

# Runs a command quietly; its output is shown if it fails.
quietly() {
  log=$(mktemp)
  if "$@" >"$log" 2>&1; then rm -f "$log"; else cat "$log" >&2; rm -f "$log"; return 1; fi
}

prepare() {
  install_missing "$2" || return 1
  say "Building (some minutes the first time) ..."
  quietly cmake --preset "$1" || return 1
  set -- cmake --build --preset "$1" --target "$3"
  if [ -t 2 ]; then "$@" >&2; else quietly "$@"; fi
}
