#!/usr/bin/env bash
# The release commands with what they must refuse: release.sh REPOSITORY SCRATCH. Making a release takes minutes; the bill of
# materials, which is the part that can drift, has a test of its own.
set -euo pipefail
repository=$1 scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch/full" "$scratch/release"
refuses() { # words of the message, command…
  local words=$1 said
  shift
  if said=$("$@" 2>&1); then echo "was not refused: $*"; exit 1; fi
  [[ $said == *"$words"* ]] || { echo "says something else: $said"; exit 1; }
}
touch "$scratch/full/file"
refuses 'name the folder of the release' "$repository/tools/release.sh"
refuses "unknown option '--froce'" "$repository/tools/release.sh" --froce "$scratch/new"
refuses 'is not empty; choose another folder' "$repository/tools/release.sh" "$scratch/full"
refuses 'must be a positive integer' "$repository/tools/release.sh" "$scratch/new" --jobs none
refuses "one folder, not" "$repository/tools/release.sh" "$scratch/new" "$scratch/other"
[[ ! -e $scratch/new && ! -e $scratch/other ]] || { echo 'something was made'; exit 1; }

# A release whose files are as its checksums have them passes; with a byte more, or a file more or less, it does not.
cd "$scratch/release"
for file in mansard-0.1.0.tar.gz mansard_0.1.0_amd64.deb; do echo "$file" > "$file"; done
sha256sum -- * > ../SHA256SUMS
mv ../SHA256SUMS .
check() { "$repository/tools/check_release.sh" "$scratch/release" sums; }
check | grep -q '^passed  sums'
echo more >> mansard_0.1.0_amd64.deb
refuses 'a file differs from its checksum' check
echo mansard_0.1.0_amd64.deb > mansard_0.1.0_amd64.deb
check > /dev/null
touch stowaway
refuses 'a file has no checksum' check
rm stowaway mansard_0.1.0_amd64.deb
refuses 'a file differs from its checksum' check
refuses 'usage: tools/check_release.sh' "$repository/tools/check_release.sh" "$scratch/full"
rm -rf "$scratch"
