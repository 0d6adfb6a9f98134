#!/bin/bash
# parallel.sh TABLE.csv [DIR]: every row of the table that is not done yet, as many at a time as there are cores; then one
# table of all. GNU parallel (Debian: parallel); with --sshloginfile hosts.txt also on other computers with the same disk.
set -euo pipefail
table=$1
folder=${2:-cases}
meshwind=${MESHWIND:-meshwind}
left=$("$meshwind" study merge "$table" -o "$folder" --left)
if [[ -n $left ]]; then
    # Rows that fail do not stop the others; what they said is in $folder/log.
    tr , '\n' <<<"$left" | parallel --joblog "$folder.log.tsv" --results "$folder/log" \
        "$meshwind" --threads 1 --quiet study cases "$table" --row {} -o "$folder" >/dev/null 2>&1 || true
fi
"$meshwind" study merge "$table" -o "$folder"
