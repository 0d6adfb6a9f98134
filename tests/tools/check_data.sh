#!/bin/bash
# check_data.sh [ROOT]: data/README.md has a row with the right SHA-256 for every file of data/. A row that ends in /
# stands for all files of a folder: the SHA-256 of the sorted list that sha256sum prints of them. `own` in its place: the
# project's own text, which changes with it.
set -euo pipefail
cd "${1:-"$(dirname -- "${BASH_SOURCE[0]}")/../.."}/data"
export LC_ALL=C

# sum_of FILE_OR_FOLDER/
sum_of() {
    if [[ $1 == */ ]]; then
        find "$1" -type f | sort | xargs -r -d '\n' sha256sum | sha256sum | cut -d ' ' -f 1
    else
        sha256sum "$1" | cut -d ' ' -f 1
    fi
}

broken=0
complain() {
    echo "data/README.md: $*"
    broken=1
}

# Rows as "name sum".
# shellcheck disable=SC2016 # the backquotes are Markdown's
rows=$(sed -nE 's/^\| `([^`]+)` \|.*\| `([0-9a-f]{64}|own)` \|$/\1 \2/p' README.md)
folders=()
names=' README.md '
while read -r name stated; do
    [[ $name != */ ]] || folders+=("$name")
    names+="$name "
    if [[ ! -e $name ]]; then
        complain "lists $name, which is not there"
        continue
    fi
    [[ $stated != own ]] || continue
    found=$(sum_of "$name")
    [[ $found == "$stated" ]] || complain "$name has the SHA-256 $found"
done <<<"$rows"

while IFS= read -r file; do
    for folder in "${folders[@]}"; do
        [[ $file != "$folder"* ]] || continue 2
    done
    [[ $names == *" $file "* ]] || complain "lacks a row for $file"
done < <(find . -type f -printf '%P\n' | sort)
exit "$broken"
