#!/usr/bin/env bash
# Compiles headers alone, each in a source of its own, so that none needs what another includes before it.
#   tools/check_headers.sh          the public header of every module, mansard/<module>/<module>.hpp: about 20 CPU seconds
#   tools/check_headers.sh --all    every header of modules, laboratory and programs: about 4 CPU minutes
# CXX is the compiler (g++), JOBS how many run at once (2). Exit code 1 when a header fails; its name is printed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
packages=(gdal cbc libpng tbb openssl)
case ${1:-} in
  '') mapfile -t headers < <(for m in mansard/*/ lab/*/; do h=$m$(basename "$m").hpp; [[ ! -e $h ]] || echo "$h"; done) ;;
  --all)
    packages+=(python3)
    mapfile -t headers < <(find mansard lab apps -name node_modules -prune -o -name '*.hpp' -print | LC_ALL=C sort)
    ;;
  *) echo "check_headers: unknown argument '$1'; expected --all or nothing" >&2; exit 2 ;;
esac
[[ ${#headers[@]} -gt 20 ]] || { echo "check_headers: found only ${#headers[@]} headers" >&2; exit 2; }
read -ra libraries < <(pkg-config --cflags "${packages[@]}")
compile() {  # header
  # As an #include: `#pragma once` in a main file is a warning.
  if "${CXX:-g++}" -std=c++20 -I. "${@:2}" -fsyntax-only -x c++ - <<< "#include \"$1\""; then
    echo "check_headers: $1: passed"
  else
    echo "check_headers: $1: failed"
    return 1
  fi
}
export -f compile
code=0
results=$(printf '%s\n' "${headers[@]}" | xargs -P "${JOBS:-2}" -I{} bash -c 'compile "$@"' _ {} "${libraries[@]}") || code=1
if [[ ${1:-} == --all || $code -ne 0 ]]; then LC_ALL=C sort <<< "$results"; fi
exit $code
