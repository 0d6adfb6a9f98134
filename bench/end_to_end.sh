#!/bin/bash
# bench/end_to_end.sh PROGRAM [MANDREL [OPTION...]]: times the main job, prints where the time went.
set -euo pipefail

if [ $# -lt 1 ]; then
    sed -n '2s/^# //p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi
program=$1
mandrel=${2:-tee.stl}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
echo "$("$program" --version) on $(nproc) cores, $mandrel"
status=0
"$program" "$mandrel" "${@:3}" -o "$out" --quiet || status=$?
if [ "$status" -gt 1 ]; then # 1: planned, but a check failed: the times still count
    exit "$status"
fi
python3 - "$out/report.json" <<'EOF'
import json
import sys

report = json.load(open(sys.argv[1]))
for stage, seconds in sorted(report["timing_s"].items(), key=lambda item: item[1]):
    print(f"{stage:8} {seconds:8.2f} s")
library = report["plan"].get("library")
if library:
    rate = library["candidates"] / report["timing_s"]["plan"]
    print(f"{library['candidates']} candidates, {rate:.0f} a second of planning; "
          f"covered {100 * report['plan']['coverage']['fraction']:.2f} %")
if "verification" in report:
    verify = report["timing_s"]["verify"]
    print(f"{report['program']['blocks']} blocks wound again, {verify / report['timing_s']['plan']:.2f} of the "
          f"time of planning, coarse ones made finer included")
EOF
