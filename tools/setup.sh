#!/usr/bin/env bash
# Installs the missing packages of packages.txt: tools/setup.sh [--list FILE] [PURPOSE…]
# A PURPOSE is a section of the list, for example `build`; without one, all sections are installed. When nothing is missing it
# takes no time and needs no root.
# A line is a package, or `package unless:command`, which is skipped where that command can be found.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

list=packages.txt
if [[ ${1:-} == --list ]]; then
  list=${2:?"setup: --list FILE"}
  shift 2
fi
fail() { echo "setup: $*" >&2; exit 1; }

wanted=() purpose='' purposes=()
while read -r package condition; do
  if [[ $package =~ ^\[(.*)\]$ ]]; then
    purpose=${BASH_REMATCH[1]}
    purposes+=("$purpose")
    continue
  fi
  [[ -n $package ]] || continue
  case $condition in
    '') ;;
    unless:?*) if command -v "${condition#unless:}" > /dev/null; then continue; fi ;;
    *) fail "$list: $package: '$condition' is not unless:command" ;;
  esac
  [[ $# -eq 0 || " $* " == *" $purpose "* ]] || continue
  [[ " ${wanted[*]} " == *" $package "* ]] || wanted+=("$package")
done < <(sed -e 's/#.*//' "$list")
for name in "$@"; do
  [[ " ${purposes[*]} " == *" $name "* ]] || fail "$list has no section [$name]; it has: ${purposes[*]}"
done
[[ ${#wanted[@]} -gt 0 ]] || fail "$list lists nothing"

if ! command -v dpkg-query > /dev/null || ! command -v apt-get > /dev/null; then
  echo "setup: this machine has no apt; continuing on the assumption that the equivalents of $list are installed" >&2
  exit 0
fi

missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2> /dev/null || true)
  [[ $status == installed* ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  exit 0
fi

echo "setup: installing ${missing[*]}" >&2
as_root=(env DEBIAN_FRONTEND=noninteractive)
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo > /dev/null ||
    fail "neither root nor sudo; as root, run: apt-get install --no-install-recommends ${missing[*]}"
  as_root=(sudo "${as_root[@]}")
fi
# Another apt may be at work: wait for its lock rather than fail.
apt=("${as_root[@]}" apt-get -qq -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3)
"${apt[@]}" update >&2
"${apt[@]}" install -y --no-install-recommends "${missing[@]}" >&2
