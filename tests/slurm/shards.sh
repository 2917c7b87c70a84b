#!/usr/bin/env bash
# A study as an array of 8 shards over two nodes, one task of them killed and requeued on its way,
# merges to the bytes of a run on one machine. Called by cluster.sh with the program as its argument.
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

# Kills task 2 when the first of its rows are stored.
for _ in $(seq 1200); do
    if compgen -G "$work/cluster/shards/2-of-8/parts/part-*" >/dev/null; then
        nodes=$(squeue -h -t R -o %N | sort -u | tr '\n' ' ')
        scontrol requeue "${array}_2"
        break
    fi
    sleep 0.05
done
echo "running on: ${nodes:-no node}"

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
[ "${nodes:-}" = "n1 n2 " ] || fail "the shards did not run on both nodes"
[ -e "$work/cluster/manifest.json" ] || fail "the shards were not merged"
grep -q "stopping: what is solved is being stored" "$work/cluster/slurm/shard-2.log" ||
    fail "task 2 was not killed"
grep -q "solved [0-9]* rows, reused [1-9]" "$work/cluster/slurm/shard-2.log" ||
    fail "task 2 did not go on from what it had"
for table in responses.parquet scenarios.parquet patterns.parquet summary.txt manifest.json; do
    cmp "$work/single/$table" "$work/cluster/$table" || fail "$table differs"
done
echo "8 shards over two nodes, task 2 killed and requeued: the same bytes as on one machine"
