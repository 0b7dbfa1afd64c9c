#!/usr/bin/env bash
# Every C++ file has the layout of .clang-format. Skipped (77) where clang-format 14 is not installed.
set -euo pipefail
cd "$1"
command -v clang-format > /dev/null || { echo "clang-format is not installed"; exit 77; }
[[ $(clang-format --version) == *"version 14."* ]] || { echo "another clang-format than 14 lays out differently"; exit 77; }
mapfile -t files < <(find mansard lab apps tests bench fuzz tools \( -name node_modules -o -name build \) -prune -o -name '*.[ch]pp' -print | sort)
[[ ${#files[@]} -gt 500 ]] || { echo "found only ${#files[@]} C++ files"; exit 1; }
wrong=$(clang-format --dry-run -Werror "${files[@]}" 2>&1 | grep -E ': error:' | cut -d: -f1 | sort -u || true)
[[ -z $wrong ]] || { printf 'run clang-format -i on these files:\n%s\n' "$wrong"; exit 1; }
