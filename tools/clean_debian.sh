#!/usr/bin/env bash
# Runs `make demo` and `make test` where nothing is installed beforehand: makes a Debian 12 with debootstrap, clones HEAD of
# this checkout into it, and runs the two commands there. Exit code 1 when one of them fails.
#   tools/clean_debian.sh [OPTION…] [FOLDER]    FOLDER: where Debian is installed, default /var/tmp/mansard-debian; the logs
#                                               are written to FOLDER.logs
#   --only setup|demo|test   run this only; may be repeated (default: demo, then test)
#   --run COMMAND            run a shell command in the checkout, after these; may be repeated
#   --ccache DIR             use the compiler cache DIR; without it everything is compiled
#   --keep                   keep FOLDER; otherwise it is removed at the end
#   --continue               use FOLDER as an earlier run with --keep left it; only the checkout is replaced
# Needs root, debootstrap, a network, 10 GB and, without a compiler cache, an hour on two cores. Debian's mirror, the proxy and
# the certificates are those of this machine; MIRROR names another mirror. Data in ../shared/data can be read inside.
# Every command runs in mount and process namespaces of its own: when it ends, nothing stays mounted and nothing runs on.
set -euo pipefail
{  # bash reads all of it before it begins: the checkout may change meanwhile
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
fail() { echo "clean_debian: $*" >&2; exit 2; }

steps=() commands=() cache='' keep='' continue='' folder=''
while [[ $# -gt 0 ]]; do
  case $1 in
    --only | --run | --ccache)
      [[ $# -ge 2 ]] || fail "$1 needs a value"
      case $1 in
        --only) [[ $2 =~ ^(setup|demo|test)$ ]] || fail "--only '$2': must be setup, demo or test"; steps+=("$2") ;;
        --run) commands+=("$2") ;;
        --ccache) cache=$(realpath -m -- "$2") ;;
      esac
      shift ;;
    --keep) keep=yes ;;
    --continue) continue=yes ;;
    -*) fail "unknown option '$1'; the first lines of tools/clean_debian.sh list all" ;;
    *) [[ -z $folder ]] || fail "one folder, not '$folder' and '$1'"; folder=$1 ;;
  esac
  shift
done
[[ ${#steps[@]} -gt 0 || ${#commands[@]} -gt 0 ]] || steps=(demo test)
folder=$(realpath -m -- "${folder:-/var/tmp/mansard-debian}")
case $folder/ in "$repository"/*) fail "$folder is inside the checkout" ;; esac
logs=$folder.logs
marker=$folder/.made-by-clean_debian
[[ $(id -u) -eq 0 ]] || fail "a chroot needs root"
command -v debootstrap > /dev/null || fail "debootstrap is missing: apt-get install debootstrap"
unshare --mount --pid --fork true 2> /dev/null || fail "namespaces are not permitted here (in a container: --privileged)"

mounted() { awk -v folder="$folder" '$5 == folder || index($5, folder "/") == 1' /proc/self/mountinfo | grep -q .; }
remove() {
  [[ -e $folder ]] || return 0
  [[ -e $marker ]] || fail "$folder was not made by this script; it is left alone"
  ! mounted || fail "something is mounted below $folder; it is left alone"
  rm -rf --one-file-system "$folder"
}

# A command in Debian.
enter() {
  unshare --mount --pid --fork --kill-child --propagation private bash -euc '
    root=$1 data=$2 cache=$3
    shift 3
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"  # Chromium shares pictures here
    mount --bind /sys "$root/sys"
    mount -o remount,bind,ro "$root/sys"
    if [[ -n $data ]]; then
      mkdir -p "$root/src/shared/data"
      mount --bind "$data" "$root/src/shared/data"
      mount -o remount,bind,ro "$root/src/shared/data"
    fi
    if [[ -n $cache ]]; then
      mkdir -p "$root/ccache"
      mount --bind "$cache" "$root/ccache"
    fi
    exec chroot "$root" /usr/bin/env -i "$@"' enter "$folder" "$data" "$cache" "${environment[@]}" "$@"
}

# ---- a Debian 12 with git and make
if [[ -n $continue ]]; then
  [[ -e $marker ]] || fail "--continue: $folder was not made by this script"
else
  remove
fi
mkdir -p "$logs" "$folder"
touch "$marker"
trap '[[ -n $keep ]] || remove' EXIT

# The mirror that this machine uses, if it is a Debian 12 itself.
mirror_of() {  # codename
  apt-get indextargets --format '$(ORIGIN) $(CODENAME) $(REPO_URI)' 'Created-By: Packages' 2> /dev/null |
    awk -v codename="$1" '$1 == "Debian" && $2 == codename && !seen++ { print $3 }' || true
}
mirror=${MIRROR:-$(mirror_of bookworm)}
mirror=${mirror:-http://deb.debian.org/debian}
security=$(mirror_of bookworm-security)
security=${security:-http://deb.debian.org/debian-security}
if [[ -z $continue ]]; then
  echo "== Debian 12 from $mirror into $folder"
  unshare --mount --pid --fork --kill-child --propagation private \
    debootstrap --variant=minbase --include=ca-certificates,git,make bookworm "$folder" "$mirror" \
    > "$logs/debootstrap.log" 2>&1 || { tail -20 "$logs/debootstrap.log" >&2; exit 2; }
fi
cat > "$folder/etc/apt/sources.list" <<END
deb $mirror bookworm main
deb $mirror bookworm-updates main
deb $security bookworm-security main
END
printf '#!/bin/sh\nexit 101\n' > "$folder/usr/sbin/policy-rc.d"  # no services
chmod +x "$folder/usr/sbin/policy-rc.d"

# ---- how this machine reaches the network
for file in /etc/resolv.conf /etc/hosts; do [[ ! -e $file ]] || cp -L "$file" "$folder$file"; done
# How apt fetches, without hooks, which may call programs that are not in there.
apt-config dump Acquire 2> /dev/null | grep -vE 'IndexTargets|Proxy-Auto-Detect|ProxyAutoDetect' \
  > "$folder/etc/apt/apt.conf.d/90machine" || true
for file in /etc/apt/auth.conf /etc/apt/auth.conf.d; do [[ ! -e $file ]] || cp -r "$file" "$folder/etc/apt/"; done
environment=(PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8)
for name in http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY JOBS; do
  [[ -z ${!name:-} ]] || environment+=("$name=${!name}")
done
# Certificates of a proxy.
if compgen -G '/usr/local/share/ca-certificates/*.crt' > /dev/null; then
  cp -rL /usr/local/share/ca-certificates "$folder/usr/local/share/"
  chroot "$folder" update-ca-certificates > /dev/null 2>&1
fi
bundle=${NODE_EXTRA_CA_CERTS:-$(cd / && npm config get cafile 2> /dev/null || true)}
if [[ -s $bundle ]]; then
  cp -L "$bundle" "$folder/etc/ssl/extra.pem"
  environment+=(NODE_EXTRA_CA_CERTS=/etc/ssl/extra.pem)
fi
# npm's registry, and how it is reached.
if command -v npm > /dev/null; then
  for key in registry proxy https-proxy noproxy strict-ssl; do
    value=$(cd / && npm config get "$key" 2> /dev/null || true)
    [[ $value =~ ^(|null|undefined)$ ]] || environment+=("npm_config_${key//-/_}=$value")
  done
  npmrc=$(cd / && npm config get userconfig 2> /dev/null || true)
  [[ ! -s $npmrc ]] || install -m 600 "$npmrc" "$folder/root/.npmrc"
fi

# ---- the checkout
data=''
[[ ! -d $repository/../shared/data ]] || data=$(realpath "$repository/../shared/data")
if [[ -n $cache ]]; then
  mkdir -p "$cache"
  limit=$(CCACHE_DIR=$cache ccache --get-config max_size 2> /dev/null || echo 0)
  environment+=(CCACHE_DIR=/ccache "CCACHE_MAXSIZE=$limit")
  echo "== compiled files are taken from $cache and added to it"
else
  echo "== no compiler cache: everything is compiled"
fi
as_given=(git -c safe.directory='*' -C "$repository")
commit=$("${as_given[@]}" rev-parse --short HEAD)
[[ -z $("${as_given[@]}" status --porcelain) ]] || echo "== changes that are not committed are left out"
checkout=$folder/src/mansard
"${as_given[@]}" bundle create --quiet "$folder/HEAD.bundle" HEAD
if [[ -n $continue && -d $checkout/.git ]]; then
  git -C "$checkout" fetch --quiet "$folder/HEAD.bundle" HEAD
  git -C "$checkout" checkout --quiet --detach FETCH_HEAD
else
  mkdir -p "$folder/src"
  git -c advice.detachedHead=false clone --quiet "$folder/HEAD.bundle" "$checkout"
fi
echo "== mansard $commit in $folder/src/mansard"

# ---- the commands
failed=0
step() {  # name of its log, command
  local log=$logs/$1.log said=passed
  local start=$SECONDS TIMEFORMAT='%U %S'
  { time enter bash -c "cd /src/mansard && $2" > "$log" 2>&1 || said=FAILED; } 2> "$logs/time"
  printf '%-7s %s   %d s, %d s of CPU   %s\n' "$said" "$2" $((SECONDS - start)) \
    "$(awk '{ printf "%d", $1 + $2 }' "$logs/time")" "$log"
  [[ $said == passed ]] || failed=1
  if grep -q '^[0-9]*% tests passed,' "$log"; then
    sed -n '/^[0-9]*% tests passed,/,$p' "$log"
  elif [[ $said == FAILED ]]; then
    tail -30 "$log"
  fi
}
for name in "${steps[@]}"; do step "$name" "make $name"; done
count=0
for command in "${commands[@]}"; do step "run-$((count += 1))" "$command"; done
[[ -z $keep ]] || echo "== $folder is kept"
exit $failed
}
