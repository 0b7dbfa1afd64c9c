#!/bin/sh
# The long run of the extrusion kernel's tests: every guarantee of docs/extrude.md over 100,000 random plans and more (a
# test run takes 5,000), from a seed that is new every night, and the shared polygons.
#
#   tools/nightly.sh [test_extrude [runs [seed]]]        build/release/bin/test_extrude 100000 <the date>
#
# The same program as in the test run, steered by the environment:
#   MANSARD_RUNS=n            random plans for all guarantees together
#   RC_PARAMS="seed=n"        where they begin; a failure says which seed repeats it
#   MANSARD_KEEP_FAILURES=1   every failing plan, made small, is written to tests/extrude/fixtures, where it is raised and
#                             judged in every test run from then on
# Uses every core. Exit code 1 when anything failed; what each part said is in nightly-*.log beside the program.
set -u
program=${1:-build/release/bin/test_extrude}
runs=${2:-100000}
seed=${3:-$(date +%Y%m%d)}
cores=$(nproc)
logs=$(dirname "$program")

export MANSARD_RUNS="$runs" RC_PARAMS="seed=$seed" MANSARD_KEEP_FAILURES=1
echo "$runs random plans from seed $seed on $cores cores"
failed=0
shard=0
pids=""
while [ "$shard" -lt "$cores" ]; do
  GTEST_TOTAL_SHARDS=$cores GTEST_SHARD_INDEX=$shard "$program" \
    --gtest_filter='Guarantee.*:*SharedPolygons*:*Fixture*' >"$logs/nightly-$shard.log" 2>&1 &
  pids="$pids $!"
  shard=$((shard + 1))
done
for pid in $pids; do
  wait "$pid" || failed=1
done
grep -hE '^\[  (PASSED|FAILED)' "$logs"/nightly-*.log
exit $failed
