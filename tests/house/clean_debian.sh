#!/usr/bin/env bash
# Runs tools/clean_debian.sh among stand-ins for debootstrap, namespaces and git.
#   clean_debian.sh REPOSITORY CASE
set -euo pipefail
repository=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
export PATH=$scratch/bin:$PATH
calls=$scratch/calls
: > "$calls"
folder=$scratch/debian

fail() { echo "$*" >&2; cat "$scratch/stdout" "$calls" >&2; exit 1; }
stand_in() {  # name, body
  printf '#!/bin/bash\necho "%s $*" >> "%s"\n%s\n' "$1" "$calls" "$2" > "$scratch/bin/$1"
  chmod +x "$scratch/bin/$1"
}
called() { grep -qE -- "$1" "$calls"; }
run() { (cd / && "$repository/tools/clean_debian.sh" "$@") > "$scratch/stdout" 2>&1; }
refuses() {  # what must be said, arguments
  local code=0
  run "${@:2}" || code=$?
  [[ $code -eq 2 ]] || fail "exit code $code instead of 2"
  grep -qF -- "$1" "$scratch/stdout" || fail "not said: $1"
  ! called '^debootstrap' || fail "Debian was installed nevertheless"
}

stand_in id 'echo 0'
stand_in debootstrap "mkdir -p '$folder'/{etc/apt/apt.conf.d,etc/ssl,usr/sbin,usr/local/share,root}"
stand_in chroot ''
stand_in git 'case " $* " in *" rev-parse "*) echo abc1234 ;; *" clone "*) mkdir -p "${@: -1}/.git" ;; esac'
stand_in npm ''
# Without namespaces: what is run in Debian is written down, and fails if it has to do with $BREAKS.
stand_in unshare 'while [[ $1 == --* ]]; do [[ $1 != --propagation ]] || shift; shift; done
[[ $1 == bash ]] || exec "$@"
echo "in Debian: ${@: -1}" >> "'"$calls"'"
[[ -z ${BREAKS:-} || ${@: -1} != *"$BREAKS"* ]]'

case $2 in
  clean_debian_runs_both_commands_in_a_clone_and_removes_it)
    run "$folder" || fail "failed"
    called '^debootstrap .*bookworm '"$folder" || fail "no Debian"
    [[ $(grep -n 'in Debian: cd /src/mansard && make demo' "$calls" | cut -d: -f1) -lt \
       $(grep -n 'in Debian: cd /src/mansard && make test' "$calls" | cut -d: -f1) ]] || fail "not demo, then test"
    grep -q '^passed  make test .*debian.logs/test.log' "$scratch/stdout" || fail "no result"
    grep -q 'no compiler cache' "$scratch/stdout" || fail "does not say that everything is compiled"
    [[ ! -e $folder && -e $folder.logs/test.log ]] || fail "the folder is left, or the log is gone"
    ;;
  clean_debian_fails_when_a_command_fails)
    code=0
    BREAKS='make demo' run --keep "$folder" || code=$?
    [[ $code -eq 1 ]] || fail "exit code $code instead of 1"
    grep -q '^FAILED  make demo' "$scratch/stdout" || fail "does not say what failed"
    called 'in Debian: .*make test' || fail "make test was left out"
    [[ -d $folder ]] || fail "--keep removed it"
    ;;
  clean_debian_runs_what_is_asked_for_only)
    run --only demo --run 'ctest -R a' "$folder" || fail "failed"
    called 'in Debian: .*make demo$' && called 'in Debian: .*ctest -R a$' || fail "not both"
    ! called 'in Debian: .*make test' || fail "make test too"
    ;;
  clean_debian_continues_in_a_folder_that_it_kept)
    run --keep --only setup "$folder" || fail "failed"
    : > "$calls"
    run --continue --only demo "$folder" || fail "failed"
    ! called '^debootstrap' || fail "Debian was installed again"
    ;;
  clean_debian_refuses_what_it_must_not_touch)
    mkdir "$folder"
    touch "$folder/mine"
    refuses 'was not made by this script' "$folder"
    [[ -e $folder/mine ]] || fail "somebody's file is gone"
    refuses 'was not made by this script' --continue "$folder"
    refuses 'is inside the checkout' "$repository/build/debian"
    ;;
  clean_debian_refuses_arguments_that_it_does_not_know)
    refuses "unknown option '--kep'" --kep
    refuses "--only 'tests'" --only tests
    refuses '--only needs a value' --only
    stand_in id 'echo 1000'
    refuses 'needs root' "$folder"
    ;;
  *)
    fail "no such case: $2"
    ;;
esac
