#!/bin/bash
# check_error_codes.sh [ROOT]: docs/errors.md lists the error codes of the sources, all of them and no others.
set -euo pipefail
cd "${1:-"$(dirname -- "${BASH_SOURCE[0]}")/../.."}"
export LC_ALL=C

# A code is a string literal of two words joined by a point whose second word is no file extension.
in_sources=$(grep -rhoE --include='*.cpp' --include='*.h' '"[a-z]+\.[a-z][a-z_]+"' \
    core mesh geodesic winding machines postproc study pipeline report cli | tr -d '"' |
    grep -vE '\.(json|csv|ngc|nc|vtu|html|stl|obj|ply|off|src|txt|log|tmp|yaml|md|mpf|cnc|gcode|glb|step|svg)$' | sort -u)
# shellcheck disable=SC2016 # the backquotes are Markdown's
in_table=$(grep -oE '^\| `[a-z]+\.[a-z_]+`' docs/errors.md | tr -d '|` ' | sort -u)

missing=$(comm -23 <(echo "$in_sources") <(echo "$in_table"))
stale=$(comm -13 <(echo "$in_sources") <(echo "$in_table"))
[[ -z $missing ]] || echo "docs/errors.md lacks: ${missing//$'\n'/, }"
[[ -z $stale ]] || echo "docs/errors.md lists, but no source has: ${stale//$'\n'/, }"
[[ -z $missing$stale ]]
