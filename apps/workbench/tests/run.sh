#!/usr/bin/env bash
# run.sh logic|browser|firefox BUILT [ARGUMENT…]: runs the unit tests of the page, or those in Chromium or Firefox, in a copy of it
# that uses the packages of the build folder BUILT. The arguments are Playwright's (--grep TEXT). Ends with 77 where Firefox, or
# the screen without a monitor that its WebGL needs, is missing.
set -euo pipefail
workbench=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
what=$1
built=$(cd "$2" && pwd)
shift 2
if [[ $what == firefox ]]; then
  for program in "${FIREFOX:-firefox-esr}" Xvfb; do
    command -v "$program" >/dev/null || { echo "skipped: $program is not installed (tools/setup.sh firefox)"; exit 77; }
  done
fi
copy=$(mktemp -d)
screen=
trap '[[ -z $screen ]] || kill "$screen" 2>/dev/null; rm -rf "$copy"' EXIT
cp -r "$workbench"/{src,tests,package.json,tsconfig.json,vite.config.ts,playwright.config.ts} "$copy"
ln -s "$built/node_modules" "$copy/node_modules"
cd "$copy"
export MANSARD_TEST_RESULTS=${MANSARD_TEST_RESULTS:-$copy/results}
case $what in
  logic) node node_modules/typescript/bin/tsc --noEmit && node node_modules/vitest/vitest.mjs run "$@" ;;
  browser) node node_modules/@playwright/test/cli.js test "$@" ;;
  firefox)
    mkfifo number
    # Xvfb chooses a number that is free, and writes it when it is ready.
    Xvfb -displayfd 3 -screen 0 1600x1000x24 -nolisten tcp 3>number >/dev/null 2>&1 &
    screen=$!
    read -r number <number
    mkdir downloads
    export MANSARD_DOWNLOADS=$copy/downloads
    DISPLAY=:$number MANSARD_BROWSER=firefox node node_modules/@playwright/test/cli.js test "$@"
    ;;
  *) echo "run.sh: unknown tests '$what'; expected logic, browser or firefox" >&2; exit 2 ;;
esac
