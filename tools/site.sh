#!/usr/bin/env bash
# Builds the docs site: tools/site.sh OUT. Fails when a page does not agree with the tree or the program.
# MANSARD is the program to ask (default: the release build); WORK is where marked is installed, once (default: build/site).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[[ $# -eq 1 ]] || { echo "usage: tools/site.sh OUT" >&2; exit 2; }
mansard=$(realpath -m "${MANSARD:-$root/build/release/bin/mansard}")
work=$(realpath -m "${WORK:-$root/build/site}")
[[ -x $mansard ]] || { echo "site: $mansard is not there; 'make build' makes it" >&2; exit 3; }

# node resolves packages beside the script, so the script goes where the package is, out of the source tree.
mkdir -p "$work"
for file in package.json package-lock.json; do
  cmp -s "$root/tools/site/$file" "$work/$file" || { rm -rf "$work/node_modules"; cp "$root/tools/site/$file" "$work/"; }
done
[[ -d $work/node_modules/marked ]] ||
  (cd "$work" && npm ci --ignore-scripts --no-audit --no-fund --prefer-offline > "$work/npm.log" 2>&1) ||
  { cat "$work/npm.log" >&2; exit 3; }
cp "$root"/tools/site/*.mjs "$work/"
mkdir -p "$(dirname "$1")"
node "$work/build.mjs" "$root" "$mansard" "$1"
