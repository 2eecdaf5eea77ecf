#!/bin/sh
# Installs a build and compiles a project against it: test.sh BUILD_DIR SOURCE_DIR
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$1" --prefix "$work/prefix" >"$work/log"
"$work/prefix/bin/traceraft" --version
for file in man/man1/traceraft.1 bash-completion/completions/traceraft zsh/site-functions/_traceraft \
  fish/vendor_completions.d/traceraft.fish doc/traceraft/CHANGELOG.md doc/traceraft/docs/guide.md \
  doc/traceraft/verification/data/README.md; do
  test -s "$work/prefix/share/$file" || { echo "$file is not installed"; exit 1; }
done
"$work/prefix/bin/traceraft" man | cmp - "$work/prefix/share/man/man1/traceraft.1"
cmake -G Ninja -S "$2" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/log"
cmake --build "$work/build" >"$work/log" || { cat "$work/log"; exit 1; }
"$work/build/consumer"
