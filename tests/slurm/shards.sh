#!/usr/bin/env bash
# A study as an array of 8 shards over two nodes, one task of them killed and requeued on its way and one
# signalled as before its time limit, merges to the bytes of a run on one machine. Called by cluster.sh
# with the program as its argument.
set -euo pipefail
blisk=$1
study=$(dirname "${BASH_SOURCE[0]}")/shards.toml
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$blisk" run "$study" --out "$work/single" --threads 1 >/dev/null
"$blisk" slurm "$study" --tasks 8 --out "$work/cluster" --script "$work/submit.sh"
jobs=$(bash "$work/submit.sh")
echo "$jobs"
array=$(sed -n 's/^shards: job \([0-9]*\),.*/\1/p' <<<"$jobs")

# Waits until the first rows of a shard are stored.
await_rows() {
    for _ in $(seq 1200); do
        ! compgen -G "$work/cluster/shards/$1-of-8/parts/part-*" >/dev/null || return 0
        sleep 0.02
    done
}
await_rows 3
await_rows 2
nodes=$(squeue -h -t R -o %N | sort -u | tr '\n' ' ')
# It tries again for seconds after the signal has gone.
scancel --verbose --batch --signal=USR1 "${array}_3" &
scontrol requeue "${array}_2"
wait || true
echo "running on: $nodes"

for _ in $(seq 600); do
    [ -n "$(squeue -h)" ] || break
    sleep 0.5
done
fail() {
    echo "$1" >&2
    squeue >&2
    tail -n 20 "$work"/cluster/slurm/*.log >&2
    exit 1
}
[ -z "$(squeue -h)" ] || fail "the jobs do not end"
[ "$nodes" = "n1 n2 " ] || fail "the shards did not run on both nodes"
[ -e "$work/cluster/manifest.json" ] || fail "the shards were not merged"
grep -q "error: interrupted: [0-9]* of " "$work/cluster/slurm/shard-3.log" ||
    fail "task 3 did not hear its signal"
for task in 2 3; do
    grep -q "solved [0-9]* rows, reused [1-9]" "$work/cluster/slurm/shard-$task.log" ||
        fail "task $task did not go on from what it had"
done
for table in responses.parquet scenarios.parquet patterns.parquet summary.txt manifest.json; do
    cmp "$work/single/$table" "$work/cluster/$table" || fail "$table differs"
done
echo "8 shards over two nodes, task 2 killed and task 3 signalled on their way, both requeued: the same bytes as on one machine"
