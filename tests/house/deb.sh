#!/usr/bin/env bash
# Builds the Debian packages, looks into them, and runs the program from where it was unpacked.
#   deb.sh REPOSITORY BUILD SCRATCH [VARIABLE=VALUE…]    of the environment of Python
set -euo pipefail
repository=$1 build=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch/packages"
fail() { echo "$*" >&2; exit 1; }

(cd "$build" && cpack -G DEB -B "$scratch/packages") > "$scratch/cpack.log" 2>&1 ||
  { cat "$scratch/cpack.log" >&2; exit 1; }
program=$(echo "$scratch"/packages/mansard_*.deb)
engine=$(echo "$scratch"/packages/libmansard-dev_*.deb)
python=$(echo "$scratch"/packages/python3-mansard_*.deb)
[[ -s $program && -s $engine && -s $python ]] || fail "cpack made $(ls "$scratch/packages")"

# It depends on the libraries it is linked with, and on none of a compiler's.
depends=$(dpkg-deb -f "$program" Depends)
for library in libgdal libgeos-c1 libgmp10 libtbb libembree coinor-libcbc libpng16 libassimp libopenscenegraph libc6; do
  [[ $depends == *"$library"* ]] || fail "no dependency on $library: $depends"
done
[[ $depends != *-dev* ]] || fail "a program needs no headers: $depends"
[[ $(dpkg-deb -f "$engine" Depends) == *libgdal-dev* ]] || fail "the engine needs the headers' packages"

dpkg-deb -c "$program" | awk '{print $6}' > "$scratch/contents"
for file in bin/mansard libexec/mansard/mansard-reader share/man/man1/mansard.1.gz share/bash-completion/completions/mansard \
  share/zsh/vendor-completions/_mansard share/fish/vendor_completions.d/mansard.fish \
  share/mansard/data/hall/mesh.off share/qgis/python/plugins/mansard/metadata.txt \
  share/doc/mansard/docs/cli.md share/doc/mansard/changelog.gz share/doc/mansard/copyright share/doc/mansard/NOTICE share/doc/mansard/LICENSE; do
  grep -qx "./usr/$file" "$scratch/contents" || fail "no $file in the package"
done
! grep -vE '^\./(usr/)?$|^\./usr/(bin|share)/|^\./usr/libexec/(mansard/(mansard-reader)?)?$' "$scratch/contents" ||
  fail "the package reaches beyond /usr/bin, /usr/share and /usr/libexec/mansard"
dpkg-deb -c "$engine" | awk '{print $6}' > "$scratch/engine_contents"
grep -qx './usr/include/mansard/pipeline/pipeline.hpp' "$scratch/engine_contents" ||
  fail "no public header in the package of the engine"
! grep '/detail/' "$scratch/engine_contents" || fail "a detail/ in the package of the engine"

dpkg-deb -x "$program" "$scratch/root"
mansard=$scratch/root/usr/bin/mansard
[[ $("$mansard" --version) == "mansard $(dpkg-deb -f "$program" Version)" ]] || fail "another version inside"
! grep -aqF "$repository/data" "$mansard" || fail "the program knows the folder it was built from"
zcat "$scratch/root/usr/share/man/man1/mansard.1.gz" | cmp -s - <("$mansard" manual) ||
  fail "the manual is not the program's"
"$mansard" completion bash | cmp -s - "$scratch/root/usr/share/bash-completion/completions/mansard" ||
  fail "not its completion"
data=$scratch/root/usr/share/mansard/data
"$mansard" reconstruct -q "$data/hall/mesh.off" "$data/hall/footprints.geojson" -o "$scratch/hall" > /dev/null ||
  fail "no hall"
[[ -s $scratch/hall/model.city.json ]] || fail "no model"
# Its reader of other formats is where it looks for it, and no other mansard-reader is in PATH.
printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\nendsolid a\n' > "$scratch/a.stl"
said=$(PATH=/usr/bin:/bin "$mansard" reconstruct -q "$scratch/a.stl" "$data/hall/footprints.geojson" -o "$scratch/none" 2>&1) || true
[[ $said == *ingest-no-overlap* ]] || fail "STL is not read: $said"

# The Python package, from where it was unpacked.
[[ $(dpkg-deb -f "$python" Depends) == *python3-numpy*libgdal* || $(dpkg-deb -f "$python" Depends) == *libgdal*python3-numpy* ]] ||
  fail "python3-mansard does not depend on numpy and GDAL: $(dpkg-deb -f "$python" Depends)"
dpkg-deb -x "$python" "$scratch/root"
PYTHONPATH=$scratch/root/usr/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 env "${@:4}" /usr/bin/python3 -c "
import sys, mansard
assert mansard.__file__.startswith('$scratch'), mansard.__file__
assert len(mansard.reconstruct('$data/hall/mesh.off', '$data/hall/footprints.geojson')) == 2" || fail "no Python package"

# Where Debian's own check is installed, it has no error.
if command -v lintian > /dev/null; then
  ! lintian "$scratch"/packages/*.deb 2> /dev/null | grep '^E:' || fail "lintian finds errors"
fi

# What the page of the workbench ships is named with its licence.
page=$repository/apps/workbench/package.json
for package in $(node -p "Object.keys(require('$page').dependencies ?? {}).join(' ')"); do
  grep -qF "$package" "$scratch/root/usr/share/doc/mansard/copyright" ||
    fail "packaging/copyright does not name $package"
done
rm -rf "$scratch"
