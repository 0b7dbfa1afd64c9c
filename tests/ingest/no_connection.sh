#!/usr/bin/env bash
# Every kind of reference in every format, read under strace: no process connects to anything and none sends a datagram.
#   no_connection.sh TEST_INGEST SCRATCH
# The tests of references_test.cpp have a port of their own that nobody may call; this one sees calls to any place. Exit
# code 77, skipped, where strace is missing or the system does not permit it.
set -euo pipefail
tests=$(realpath "$1") scratch=$2
command -v strace > /dev/null || { echo "skipped: strace is not installed (tools/setup.sh test)"; exit 77; }
mkdir -p "$scratch"
export ASAN_OPTIONS=${ASAN_OPTIONS:-}:detect_leaks=0  # the search for leaks cannot be traced
calls=connect,sendto,sendmsg,sendmmsg
traced() { strace -f -qq -e trace="$calls" -e signal=none --seccomp-bpf -o "$scratch/calls" "$@"; }
traced true 2> "$scratch/why" || { echo "skipped: strace does not work here: $(head -1 "$scratch/why")"; exit 77; }

# What it is to see, it sees: a call from a process that a process starts, and a name that is asked for.
traced bash -c 'bash -c "exec 3<> /dev/tcp/127.0.0.1/9"' 2> /dev/null || true
grep -q 'connect(.*AF_INET' "$scratch/calls" || { echo "strace does not show a call that was made"; exit 1; }

traced "$tests" --gtest_filter='References.*' > "$scratch/said" || { cat "$scratch/said"; exit 1; }
ran=$(sed -n 's/^\[==========\] \([0-9]*\) tests from .* ran.*/\1/p' "$scratch/said")
[[ ${ran:-0} -ge 2 ]] || { echo "the tests of references did not run"; cat "$scratch/said"; exit 1; }
# A socket of this machine without an address beyond it (a pair, the name service's cache) reaches nobody.
if grep -E 'AF_INET|AF_PACKET|sin6?_addr' "$scratch/calls"; then
  echo "these calls were made while files were read"
  exit 1
fi
echo "$ran tests of references, no call"
