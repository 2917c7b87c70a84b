#!/usr/bin/env bash
# From the geometry to a bundle, and the check against CalculiX's own cyclic symmetry runs.
#
#   studies/calculix/run.sh [FOLDER]
#
# Needs gmsh and ccx (Debian: apt-get install gmsh calculix-ccx) and python3; blisk is taken from
# BLISK, or built. Everything is written into FOLDER (default: results/calculix). ORDER=1 makes linear
# elements.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=${1:-$here/../../results/calculix}
blisk=${BLISK:-}
if [ -z "$blisk" ]; then
    (cd "$here/../.." && cargo build --release)
    blisk=$here/../../target/release/blisk
fi
mkdir -p "$folder"
cp "$here"/*.inp "$here"/steel.inc "$here"/wheel_*.toml "$folder"
# The studies stand beside their bundles there.
for state in rest speed; do
    sed "s|^path = .*|path = \"bundle_$state\"|" "$here/study_$state.toml" >"$folder/study_$state.toml"
done
cd "$folder"

order=${ORDER:-2}
for body in blisk ring; do
    gmsh -3 "$here/$body.geo" -setnumber order "$order" -o "$body.gmsh.inp" >"$body.gmsh.log"
done
python3 "$here/prepare.py" blisk.gmsh.inp blisk.inc BORE_MASTER=BORE-LOW
python3 "$here/prepare.py" ring.gmsh.inp ring.inc RING_HOLD=first:RING-RING_LOW-RING_HIGH

for body in blisk ring; do
    "$blisk" import wheel_rest.toml --equations $body >"${body}_equations.inc"
done
for job in blisk_rest blade_rest ring_rest blisk_speed ring_speed \
    blisk_cyclic_rest ring_cyclic_rest blisk_cyclic_speed ring_cyclic_speed; do
    echo "ccx $job"
    ccx "$job" >"$job.log" 2>&1
done

for state in rest speed; do
    # Without the grounding of the ring, which CalculiX does not have.
    grep -v '^grounding_hz' "wheel_$state.toml" >"check_$state.toml"
    "$blisk" import "check_$state.toml" --out "check_$state" --frequencies 10 >/dev/null
    python3 "$here/compare.py" "check_$state/frequencies.csv" "blisk_cyclic_$state.dat" "ring_cyclic_$state.dat"
    "$blisk" import "wheel_$state.toml" --out "bundle_$state"
    "$blisk" check "study_$state.toml"
done
