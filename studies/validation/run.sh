#!/usr/bin/env bash
# Makes the validation report, its verdicts and the table of the quickstart from one build:
# results/validation/report.md, results/validation/verdicts.toml, results/README.md. Ends with 1 while
# a bar is not met that results/validation/open_bars.toml does not list, one that it lists is met, or
# one became worse. A run that was cut short goes on from the sections it has, if no source changed.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
cargo test --release --locked --test cases -- \
    --ignored --exact --nocapture validation::the_validation_report || exit 1
