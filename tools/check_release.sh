#!/usr/bin/env bash
# Installs and tries a release in a Debian 12 with nothing else in it: tools/check_release.sh FOLDER [WHAT…]
#   FOLDER    a release that tools/release.sh made
#   WHAT      sums, deb, wheel, source, site, plugin; without any, all but source
# `deb` and `wheel` get a new Debian each, without compilers; `source` runs `make demo` in the unpacked archive in a third.
# Needs root, debootstrap, a network and minutes. Debian's mirror and how it is reached are those of this machine; MIRROR names
# another mirror.
set -euo pipefail
fail() { echo "check_release: $*" >&2; exit 1; }
[[ $# -ge 1 && -s $1/SHA256SUMS ]] || { echo "usage: tools/check_release.sh FOLDER [sums|deb|wheel|source|site|plugin…]" >&2; exit 2; }
release=$(realpath -- "$1")
shift
[[ $# -gt 0 ]] || set -- sums deb wheel site plugin
version=$(sed -n 's/.* mansard-\([0-9.]*\)\.tar\.gz$/\1/p' "$release/SHA256SUMS")
[[ -n $version ]] || fail "no source archive in SHA256SUMS"
proxies=()
for name in http_proxy https_proxy no_proxy; do [[ -z ${!name:-} ]] || proxies+=("$name=${!name}"); done
machine='' scratch=$(mktemp -d)
trap 'rm -rf --one-file-system "$scratch" ${machine:+"$machine"}' EXIT

in_there() { chroot "$machine" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
  DEBIAN_FRONTEND=noninteractive "${proxies[@]}" "$@"; }
new_debian() {
  [[ $(id -u) -eq 0 ]] || { echo "check_release: a chroot needs root" >&2; exit 2; }
  command -v debootstrap > /dev/null || { echo "check_release: apt-get install debootstrap" >&2; exit 2; }
  [[ -z $machine ]] || rm -rf --one-file-system "$machine"
  mirror=${MIRROR:-$(apt-get indextargets --format '$(ORIGIN) $(CODENAME) $(REPO_URI)' 'Created-By: Packages' 2> /dev/null |
    awk '$1 == "Debian" && $2 == "bookworm" && !seen++ { print $3 }' || true)}
  mirror=${mirror:-http://deb.debian.org/debian}
  machine=$(mktemp -d)
  chmod 755 "$machine"  # apt downloads as a user of its own
  debootstrap --variant=minbase --include=ca-certificates bookworm "$machine" "$mirror" > "$scratch/debootstrap.log" 2>&1 ||
    { tail -20 "$scratch/debootstrap.log" >&2; exit 3; }
  cp /etc/resolv.conf "$machine/etc/resolv.conf"
  apt-config dump Acquire 2> /dev/null | grep -vE 'IndexTargets|Proxy-Auto-Detect|ProxyAutoDetect' > "$machine/etc/apt/apt.conf.d/90machine" || true
  for file in /etc/apt/auth.conf /etc/apt/auth.conf.d; do [[ ! -e $file ]] || cp -r "$file" "$machine/etc/apt/"; done
  if compgen -G '/usr/local/share/ca-certificates/*.crt' > /dev/null; then
    cp -rL /usr/local/share/ca-certificates "$machine/usr/local/share/"
    chroot "$machine" update-ca-certificates > /dev/null 2>&1
  fi
  in_there apt-get -qq update
}
install_there() { in_there apt-get -qq install -y --no-install-recommends "$@" > "$machine/tmp/apt.log" 2>&1 ||
  { tail -20 "$machine/tmp/apt.log" >&2; exit 3; }; }
no_compiler() { ! in_there sh -c 'command -v cc || command -v c++ || command -v cmake || command -v node' || fail "a compiler is there"; }
results_there() { # FOLDER
  for made in model.city.json model.glb plans.json run.json picture.png; do
    [[ -s $machine$1/$made ]] || fail "no $made"
  done
}
data=/usr/share/mansard/data

for what in "$@"; do
  start=$SECONDS
  case $what in
    sums)
      (cd "$release" && sha256sum --quiet -c SHA256SUMS) || fail "a file differs from its checksum"
      [[ $(ls -A "$release" | wc -l) -eq $(($(wc -l < "$release/SHA256SUMS") + 1)) ]] || fail "a file has no checksum" ;;
    deb)
      new_debian
      cp "$release/mansard_${version}_amd64.deb" "$machine/tmp/"
      install_there "/tmp/mansard_${version}_amd64.deb"
      no_compiler
      [[ $(in_there mansard --version) == "mansard $version" ]] || fail "another version"
      in_there mansard reconstruct -q $data/hall/mesh.off $data/hall/footprints.geojson -o /tmp/hall --picture
      results_there /tmp/hall
      in_there mansard reconstruct -q $data/delft/points.laz $data/delft/footprints.geojson -o /tmp/delft --picture
      results_there /tmp/delft
      in_there sh -c 'mansard manual | head -1 && test -s /usr/share/man/man1/mansard.1.gz' > /dev/null || fail "no manual"
      in_there apt-get -qq remove -y mansard > /dev/null 2>&1
      [[ ! -e $machine/usr/bin/mansard && ! -e $machine/usr/share/mansard ]] || fail "it left files behind" ;;
    wheel)
      new_debian
      # The libraries that the wheel does not bundle are those of the Debian package, which is not installed itself.
      needs=$(dpkg-deb -f "$release/python3-mansard_${version}_amd64.deb" Depends | sed 's/([^)]*)//g; s/|[^,]*//g; s/,/ /g')
      reader=$(dpkg-deb -f "$release/mansard_${version}_amd64.deb" Depends | sed 's/([^)]*)//g; s/|[^,]*//g; s/,/ /g')
      # shellcheck disable=SC2086
      install_there python3-venv $needs $reader
      no_compiler
      cp "$release"/mansard-"$version"-*.whl "$machine/tmp/"
      tar -C "$machine/tmp" -xzf "$release/mansard-$version.tar.gz" "mansard-$version/data/hall"
      in_there python3 -m venv --system-site-packages /tmp/env
      in_there sh -c '/tmp/env/bin/pip install --quiet --no-index /tmp/*.whl'
      in_there /tmp/env/bin/python -c "
import mansard
assert mansard.__version__ == '$version' and mansard.__file__.startswith('/tmp/env'), mansard.__file__
city = mansard.reconstruct('/tmp/mansard-$version/data/hall/mesh.off', '/tmp/mansard-$version/data/hall/footprints.geojson')
assert len(city) == 2
city.write('/tmp/hall.glb')" ;;
    source)
      new_debian
      install_there make
      tar -C "$machine/tmp" -xzf "$release/mansard-$version.tar.gz"
      unshare --mount --pid --fork --kill-child chroot "$machine" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
        LC_ALL=C.UTF-8 "${proxies[@]}" sh -c "mount -t proc proc /proc; cd /tmp/mansard-$version && make demo" > "$scratch/demo.log" 2>&1 ||
        { tail -30 "$scratch/demo.log" >&2; exit 3; }
      [[ -s $machine/tmp/mansard-$version/build/release/bin/mansard ]] || fail "no program" ;;
    site)
      tar -C "$scratch" -xzf "$release/mansard-$version-site.tar.gz"
      [[ -s $scratch/mansard-$version-site/index.html ]] || fail "the site has no index.html" ;;
    plugin)
      python3 - "$release/mansard-qgis-$version.zip" "$version" <<'END'
import configparser, sys, zipfile
archive = zipfile.ZipFile(sys.argv[1])
names = archive.namelist()
assert all(name.startswith("mansard/") and ".." not in name for name in names), names
metadata = configparser.ConfigParser()
metadata.read_string(archive.read("mansard/metadata.txt").decode())
assert metadata["general"]["version"] == sys.argv[2], metadata["general"]["version"]
assert {"mansard/__init__.py", "mansard/LICENSE"} <= set(names), names
for name in names:
    if name.endswith(".py"):
        compile(archive.read(name), name, "exec")
END
      ;;
    *) echo "check_release: unknown '$what'" >&2; exit 2 ;;
  esac
  printf 'passed  %-7s %d s\n' "$what" $((SECONDS - start))
done
