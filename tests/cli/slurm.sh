#!/usr/bin/env bash
# A run over Slurm on this machine: two nodes, one task killed, one node drained and a task requeued; the files are those
# of a single run. slurm.sh MANSARD WORK. Exits with 77 (skipped) and the reason where that cannot be done.
set -euo pipefail
mansard=$(realpath "$1") work=$2
skip() { echo "skipped: $*"; exit 77; }
for program in slurmctld slurmd sbatch squeue scontrol scancel munged; do
  command -v "$program" > /dev/null || skip "$program is not installed (tools/setup.sh cluster installs it)"
done
[[ $(id -u) -eq 0 ]] || skip "the daemons of Slurm need root"
getent passwd munge > /dev/null || skip "there is no user munge"

rm -rf "$work"
mkdir -p "$work"
work=$(realpath "$work")
cd "$work"
export SLURM_CONF=$work/slurm.conf
started=()
finish() {
  for process in "${started[@]}"; do kill "$process" 2> /dev/null || true; done
  wait 2> /dev/null || true
  [[ -z ${own_munge:-} ]] || rm -rf "$own_munge"
}
trap finish EXIT

# munged wants folders that only its user may write.
if ! munge -n > /dev/null 2>&1; then
  own_munge=$(mktemp -d /run/mansard-munge-XXXXXX)
  chmod 755 "$own_munge"
  dd if=/dev/urandom bs=1024 count=1 of="$own_munge/key" 2> /dev/null
  chmod 600 "$own_munge/key"
  chown -R munge: "$own_munge"
  runuser -u munge -- munged --foreground --force --socket="$own_munge/socket" --key-file="$own_munge/key" \
    --pid-file="$own_munge/pid" --log-file="$own_munge/log" --seed-file="$own_munge/seed" > munged.out 2>&1 &
  started+=($!)
  socket=",socket=$own_munge/socket"
  for _ in $(seq 100); do [[ -S $own_munge/socket ]] && break; sleep 0.1; done
  [[ -S $own_munge/socket ]] || skip "munged does not start here: $(cat "$own_munge/log")"
fi

host=$(hostname -s)
cpus=$(nproc)
free_port() { python3 -c 'import socket; s=socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])' 2> /dev/null || echo $((20000 + RANDOM % 20000)); }
cat > slurm.conf << CONF
ClusterName=mansard
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/munge
AuthInfo=cred_expire=5${socket:-}
SlurmUser=root
SlurmctldPort=$(free_port)
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool.%n
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.%n.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
KillWait=2
NodeName=one NodeHostname=$host NodeAddr=127.0.0.1 Port=$(free_port) CPUs=$cpus
NodeName=two NodeHostname=$host NodeAddr=127.0.0.1 Port=$(free_port) CPUs=$cpus
PartitionName=all Nodes=one,two Default=YES MaxTime=INFINITE State=UP
CONF
mkdir -p state spool.one spool.two
slurmctld -D -c > ctld.out 2>&1 &
started+=($!)
for node in one two; do
  slurmd -D -N "$node" > "slurmd.$node.out" 2>&1 &
  started+=($!)
done
up() { [[ $(sinfo -h -o '%t %D' 2> /dev/null) == "idle 2" ]]; }
for _ in $(seq 300); do up && break; sleep 0.1; done
up || skip "Slurm does not start here: $(sinfo 2>&1 | tail -1); $(tail -1 slurmctld.log 2> /dev/null)"

"$mansard" simulate --block detached --preset lidar-2.5d --resolution 0.6 -o scan -q > /dev/null
"$mansard" reconstruct scan/mesh.ply scan/footprints.geojson -o single --no-resume -q > /dev/null || [[ $? -eq 1 ]]

"$mansard" cluster slurm --shares 4 --cpus 1 --memory 100M -o "jöbs of mine" -- \
  reconstruct scan/mesh.ply scan/footprints.geojson -o shared -q > /dev/null
sed -i '/--mem=/d' "jöbs of mine/share.sh" "jöbs of mine/merge.sh" # nodes of this test say nothing of their memory
("./jöbs of mine/submit.sh") > submitted 2>&1 || skip "Slurm takes no jobs here: $(tail -1 submitted)"
cat submitted
shares=$(sed 's/.*shares: job \([0-9]*\).*/\1/' submitted) merge=$(sed 's/.*merge: job \([0-9]*\).*/\1/' submitted)

# While they run: one task is killed and comes back, one is requeued, and a node is drained for a while.
begun() { squeue -h -t R -j "$shares" -r 2> /dev/null | grep -q . || [[ -d shared/.mansard ]]; }
for _ in $(seq 600); do begun && break; sleep 0.05; done
begun || skip "Slurm runs no job here: $(squeue -h -o %r 2> /dev/null | sort -u | head -3)"
scontrol requeue "${shares}_1" 2> /dev/null && echo "requeued share 1" || echo "share 1 was done before it could be requeued"
scontrol update NodeName=two State=DRAIN Reason=test && echo "drained node two" || echo "node two could not be drained"
pkill -KILL -f -- "--shares 4 --share 2" && echo "killed share 2" || echo "share 2 was not running"
sleep 2
scontrol update NodeName=two State=RESUME || echo "node two could not be resumed"
ended() { [[ -z $(squeue -h -j "$1" 2> /dev/null) ]]; }
for _ in $(seq 1200); do ended "$shares" && break; sleep 0.1; done

# Whoever was killed has failed for Slurm, and is submitted again, as its user would do; the merge waits for all.
if ! grep -q . <(ls shared/.mansard/blocks 2> /dev/null); then echo "no block is kept"; exit 1; fi
if ! ended "$merge"; then
  scancel "$merge" 2> /dev/null || true
  merge=""
fi
if [[ ! -f shared/model.city.json ]]; then
  ("./jöbs of mine/submit.sh") > again
  merge=$(sed 's/.*merge: job \([0-9]*\).*/\1/' again)
  for _ in $(seq 1800); do ended "$merge" && break; sleep 0.1; done
fi
[[ -f shared/model.city.json ]] || { echo "the merge wrote nothing:"; cat "jöbs of mine"/*.log; exit 1; }
for file in model.city.json model.obj model.glb plans.json; do
  cmp "single/$file" "shared/$file" || { echo "$file is not that of a single run"; exit 1; }
done
[[ -s "jöbs of mine/share-1.log" || -f "jöbs of mine/share-1.log" ]] || { echo "no log beside the scripts"; exit 1; }
echo "four shares on two nodes gave the bytes of a single run"
