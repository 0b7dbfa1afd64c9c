#!/usr/bin/env bash
# run.sh logic|browser BUILT: runs the unit tests of the page, or those in a browser, in a copy of it that uses the packages
# of the build folder BUILT.
set -euo pipefail
workbench=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
what=$1
built=$(cd "$2" && pwd)
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
cp -r "$workbench"/{src,tests,package.json,tsconfig.json,vite.config.ts,playwright.config.ts} "$copy"
ln -s "$built/node_modules" "$copy/node_modules"
cd "$copy"
export MANSARD_TEST_RESULTS=${MANSARD_TEST_RESULTS:-$copy/results}
case $what in
  logic) node node_modules/typescript/bin/tsc --noEmit && node node_modules/vitest/vitest.mjs run ;;
  browser) node node_modules/@playwright/test/cli.js test ;;
  *) echo "run.sh: unknown tests '$what'; expected logic or browser" >&2; exit 2 ;;
esac
