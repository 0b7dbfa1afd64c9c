#!/usr/bin/env bash
# setup.sh [LIST]: installs what LIST (packages.txt) lists and this machine lacks; when nothing is missing it takes no time
# and needs no root.
# A line is a package, or `package unless:command`, which is skipped where that command can be found.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

list=${1:-packages.txt}
wanted=()
while read -r package condition; do
  case $condition in
    '') ;;
    unless:?*) if command -v "${condition#unless:}" > /dev/null; then continue; fi ;;
    *) echo "setup: $list: $package: '$condition' is not unless:command" >&2; exit 1 ;;
  esac
  [[ -z $package ]] || wanted+=("$package")
done < <(sed -e 's/#.*//' "$list")
if [[ ${#wanted[@]} -eq 0 ]]; then
  echo "setup: $list lists nothing" >&2
  exit 1
fi

if ! command -v dpkg-query > /dev/null || ! command -v apt-get > /dev/null; then
  echo "setup: no apt on this machine; going on in the hope that the equivalents of $list are installed" >&2
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
  if ! command -v sudo > /dev/null; then
    echo "setup: neither root nor sudo; as root, run: apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo "${as_root[@]}")
fi
# Another apt may be at work: wait for its lock rather than fail.
apt=("${as_root[@]}" apt-get -qq -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3)
"${apt[@]}" update >&2
"${apt[@]}" install -y --no-install-recommends "${missing[@]}" >&2
