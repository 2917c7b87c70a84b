#!/usr/bin/env bash
# A Slurm of one controller and two node daemons on this machine, from Debian's packages slurm-wlm and
# munge, as root; it ends with this script. Runs the command in its arguments with SLURM_CONF set and ends as it
# does, or with 75 if no Slurm comes up here.
set -euo pipefail

folder=$(mktemp -d)
host=$(hostname)
daemons=()
munge_started=""

end() {
    for daemon in "${daemons[@]}"; do
        kill "$daemon" 2>/dev/null || true
    done
    wait 2>/dev/null || true
    [ -z "$munge_started" ] || kill "$(cat "$munge_started")" 2>/dev/null || true
    rm -rf "$folder"
}
trap end EXIT

# Requeued tasks wait until their credential has expired, 120 s by default.
cat >"$folder/slurm.conf" <<CONF
ClusterName=blisk
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=17100
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=cred_expire=10
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool-%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=sched_interval=2,batch_sched_delay=0
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=17101 CPUs=2 RealMemory=500 State=UNKNOWN
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=17102 CPUs=2 RealMemory=500 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
mkdir -p "$folder/state" "$folder/spool-n1" "$folder/spool-n2"
export SLURM_CONF="$folder/slurm.conf"

if ! munge -n >/dev/null 2>&1; then
    mkdir -p /run/munge
    chown munge: /run/munge
    chmod 0755 /run/munge
    munge_started=/run/munge/munged.pid
    runuser -u munge -- munged
fi
slurmctld -D >"$folder/controller.out" 2>&1 &
daemons+=($!)
for node in n1 n2; do
    slurmd -D -N "$node" >"$folder/$node.out" 2>&1 &
    daemons+=($!)
done
for _ in $(seq 120); do
    if [ "$(sinfo -h -N -o %t 2>/dev/null | grep -c idle)" -eq 2 ]; then
        "$@"
        exit
    fi
    sleep 0.5
done
echo "Slurm does not come up:" >&2
tail -n 20 "$folder"/*.out "$folder"/*.log >&2
exit 75
