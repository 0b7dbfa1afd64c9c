#!/usr/bin/env bash
# Installs the Debian package in a Debian 12 with nothing else in it, and reconstructs a house there. As root, with
# debootstrap; takes minutes and some 600 MB in a temporary folder, so it is not part of the test run.
#   tools/check_deb.sh [build/release/packaging/mansard_VERSION_ARCH.deb]
# MIRROR is where Debian comes from; the apt configuration of this machine (a proxy, certificates) is used in there too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
deb=${1:-$(ls -t build/release/packaging/mansard_*.deb 2> /dev/null | head -1)}
mirror=${MIRROR:-http://deb.debian.org/debian}
[[ -s $deb ]] || { echo "check_deb: no package; 'cmake --build build/release --target package' makes one" >&2; exit 2; }
[[ $(id -u) -eq 0 ]] || { echo "check_deb: a chroot needs root" >&2; exit 2; }
command -v debootstrap > /dev/null || { echo "check_deb: apt-get install debootstrap" >&2; exit 2; }

machine=$(mktemp -d)
chmod 755 "$machine"  # apt downloads as a user of its own
trap 'rm -rf --one-file-system "$machine"' EXIT
in_there() { chroot "$machine" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
  DEBIAN_FRONTEND=noninteractive "${proxies[@]}" "$@"; }
proxies=()
for name in http_proxy https_proxy no_proxy; do [[ -z ${!name:-} ]] || proxies+=("$name=${!name}"); done

echo "== a Debian 12 from $mirror"
debootstrap --variant=minbase --include=ca-certificates bookworm "$machine" "$mirror" > "$machine.log" 2>&1 ||
  { tail -20 "$machine.log" >&2; exit 3; }
rm -f "$machine.log"
cp /etc/resolv.conf "$machine/etc/resolv.conf"
for file in /etc/apt/apt.conf.d/*proxy* /etc/apt/apt.conf; do [[ ! -e $file ]] || cp "$file" "$machine/etc/apt/apt.conf.d/"; done
cp "$deb" "$machine/tmp/mansard.deb"

echo "== installing $(basename "$deb")"
in_there apt-get -qq update
in_there apt-get -qq install -y --no-install-recommends /tmp/mansard.deb > "$machine/tmp/apt.log" 2>&1 ||
  { tail -20 "$machine/tmp/apt.log" >&2; exit 3; }

echo "== using it"
in_there mansard --version
in_there mansard reconstruct -q /usr/share/mansard/data/hall/mesh.off /usr/share/mansard/data/hall/footprints.geojson \
  -o /tmp/hall --picture
for made in model.city.json model.glb plans.json run.json picture.png; do
  [[ -s $machine/tmp/hall/$made ]] || { echo "check_deb: no $made" >&2; exit 1; }
done
in_there apt-get -qq remove -y mansard > /dev/null 2>&1
[[ ! -e $machine/usr/bin/mansard && ! -e $machine/usr/share/mansard ]] || { echo "check_deb: it left files behind" >&2; exit 1; }
echo "== all went well"
