#!/usr/bin/env bash
# Makes a release of the last commit: tools/release.sh FOLDER [--work FOLDER] [--jobs N]
#   FOLDER    the files of the release; must not exist, or be empty
#   --work    where it is built, and what is built is kept. Without it, a temporary folder that is removed.
# Everything is made from the source archive, which is made first and unpacked. The same commit on the same Debian gives the
# same bytes in any folder: docs/packaging.md, "A release". Needs what `make demo` installs, and the sections [package] and
# [python] of packages.txt.
set -euo pipefail
{  # bash reads all of it before it begins
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
fail() { echo "release: $*" >&2; exit 2; }
out='' work='' jobs=$(nproc)
while [[ $# -gt 0 ]]; do
  case $1 in
    --work | --jobs)
      [[ $# -ge 2 ]] || fail "$1 needs a value"
      if [[ $1 == --work ]]; then work=$(realpath -m -- "$2"); else jobs=$2; fi
      shift ;;
    -*) fail "unknown option '$1'; the first lines of tools/release.sh list all" ;;
    *) [[ -z $out ]] || fail "one folder, not '$out' and '$1'"; out=$(realpath -m -- "$1") ;;
  esac
  shift
done
[[ -n $out ]] || fail "name the folder of the release: tools/release.sh FOLDER"
[[ ! -e $out || -z $(ls -A "$out") ]] || fail "$out is not empty; choose another folder"
[[ $jobs =~ ^[1-9][0-9]*$ ]] || fail "--jobs '$jobs': must be a positive integer"
for tool in git cmake ninja cpack dpkg-deb objdump npm node gzip tar sha256sum python3; do
  command -v "$tool" > /dev/null || fail "$tool is missing; tools/setup.sh build package python"
done

git_here() { git -c safe.directory='*' -C "$repository" "$@"; }
commit=$(git_here rev-parse HEAD)
[[ -z $(git_here status --porcelain) ]] || echo "== changes that are not committed are left out"
SOURCE_DATE_EPOCH=$(git_here show -s --format=%ct HEAD)
export SOURCE_DATE_EPOCH TZ=UTC PYTHONDONTWRITEBYTECODE=1
umask 022
version=$(git_here show HEAD:CMakeLists.txt | sed -n 's/^project(mansard VERSION \([0-9.]*\).*/\1/p')
[[ -n $version ]] || fail "CMakeLists.txt has no version"
name=mansard-$version
if [[ -z $work ]]; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi
mkdir -p "$work" "$(dirname "$out")"
made=$work/release
rm -rf "$made"
mkdir -p "$made"
# An archive whose bytes depend on names and contents only.
pack() { # ARCHIVE FOLDER NAME
  LC_ALL=C tar -C "$2" --sort=name --mtime="@$SOURCE_DATE_EPOCH" --clamp-mtime --owner=0 --group=0 --numeric-owner \
    --mode='u+rwX,go+rX,go-w' --format=gnu -cf - "$3" | gzip -9n > "$1"
}
step() { echo "== $*"; }

step "$name of commit $commit"
git_here -c tar.umask=0022 archive --format=tar --prefix="$name/" HEAD | gzip -9n > "$made/$name.tar.gz"
source=$work/$name
rm -rf "$source"
tar -C "$work" -xzf "$made/$name.tar.gz"
cd "$source"
build=$source/build/release

step "program, libraries, Python package"
cmake --preset release -DMANSARD_TESTS=OFF -DMANSARD_PYTHON=ON -DPython3_EXECUTABLE=/usr/bin/python3 > "$work/configure.log" ||
  fail "$(tail -20 "$work/configure.log")"
grep -q '^MANSARD_LAZ:BOOL=ON' "$build/CMakeCache.txt" && command -v wasm2c > /dev/null ||
  fail "wasm2c is missing, without which LAZ is not read; tools/setup.sh build"
cmake --build "$build" -j "$jobs" > "$work/build.log" || fail "$(tail -20 "$work/build.log")"
for made_program in "$build/bin/mansard" "$build/bin/mansard-reader" "$build"/python/mansard/_core*.so; do
  ! grep -aqF "$source" "$made_program" || fail "$made_program names the folder that it was built in"
done
[[ $("$build/bin/mansard" --version) == "mansard $version" ]] || fail "the program says it is $("$build/bin/mansard" --version)"

step "Debian packages"
(cd "$build" && cpack -G DEB -B "$work/deb") > "$work/cpack.log" 2>&1 || fail "$(tail -20 "$work/cpack.log")"
for package in "$work"/deb/*.deb; do  # again, by a program that takes all times from the date of the release
  rm -rf "$work/unpacked"
  dpkg-deb -R "$package" "$work/unpacked"
  find "$work/unpacked" -exec touch -h -d "@$SOURCE_DATE_EPOCH" {} +
  dpkg-deb --threads-max=1 --root-owner-group -Zxz -b "$work/unpacked" "$made/$(basename "$package")" > /dev/null
done
rm -rf "$work/unpacked" "$work/deb"

step "wheel"
/usr/bin/python3 -c "import sys; sys.path.insert(0, 'packaging/python'); import wheel_backend
wheel_backend.build_wheel('$made', {'build-dir': 'build/release'})" 2> "$work/wheel.log" > /dev/null || fail "$(tail -20 "$work/wheel.log")"

step "plugin of QGIS, container, documentation"
# Again, without the times at which its files were made and read, which CMake's zip has.
python3 -c 'import sys, zipfile
with zipfile.ZipFile(sys.argv[1]) as old, zipfile.ZipFile(sys.argv[2], "w") as new:
    for name in sorted(name for name in old.namelist() if not name.endswith("/")):
        entry = zipfile.ZipInfo(name, (2000, 1, 1, 0, 0, 0))
        entry.external_attr, entry.compress_type = 0o100644 << 16, zipfile.ZIP_DEFLATED
        new.writestr(entry, old.read(name))' "$build/qgis/mansard.zip" "$made/mansard-qgis-$version.zip"
sed "s/@VERSION@/$version/g" packaging/Dockerfile.in > "$made/$name.Dockerfile"
rm -rf "$work/site"
mkdir -p "$work/site"
MANSARD=$build/bin/mansard WORK=$work/site_work tools/site.sh "$work/site/$name-site" > "$work/site.log" 2>&1 || fail "$(tail -20 "$work/site.log")"
pack "$made/$name-site.tar.gz" "$work/site" "$name-site"

step "bill of materials, licences, checksums"
rm -rf "$work/licences"
python3 tools/sbom.py "$made/$name.spdx.json" --commit "$commit" --licences "$work/licences/$name-licences" \
  --build "$build" -- "$made"/*
pack "$made/$name-licences.tar.gz" "$work/licences" "$name-licences"
(cd "$made" && ls | LC_ALL=C sort | xargs sha256sum -- > "$work/SHA256SUMS")
mv "$work/SHA256SUMS" "$made/"
rmdir "$out" 2> /dev/null || true
cp -r "$made" "$out.part" && mv "$out.part" "$out"
step "$out"
cat "$out/SHA256SUMS"
}
