#!/bin/bash
# make_pictures.sh: the pictures of docs/images, by the program and by the test of its page. Takes a built checkout.
set -euo pipefail
cd "$(dirname -- "${BASH_SOURCE[0]}")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
./meshwind tee.stl --machine six_axis.json -o "$work/tee" --png "$work/tee.png" --quiet
node tests/viewer/page_test.mjs "$work/tee/report.html" "$work/page"
mv "$work/tee.png" docs/images/tee.png
for kind in vessel elbow; do
    ./meshwind make "$kind" -o "$work/$kind.stl" --quiet
    ./meshwind "$work/$kind.stl" --machine six_axis.json --set tow.width=8 -o "$work/$kind" --png "docs/images/$kind.png" \
        --png-size 900x700 --quiet
done
./meshwind data/meshes/cad/lettered_elbow.stl --units m --machine six_axis.json --set tow.width=4 --set tow.friction=0.3 \
    -o "$work/part" --png docs/images/part.png --quiet
./meshwind inspect data/meshes/cad/lettered_elbow.stl --units m --page "$work/part.html"
# Its check of the coverage fails: that is what the picture shows.
./meshwind data/meshes/wye_4way_tetra.stl --machine six_axis.json --set tow.width=2 --set tow.friction=0.3 \
    --set mandrel.blend=2 --set mandrel.extension=100 --set fibres=1 -o "$work/wye" --png docs/images/close_legs.png \
    --png-size 900x700 --quiet || [[ $? == 1 ]]
node tests/viewer/part_test.mjs "$work/part.html" "$work/page"
mv "$work/page/part_light.png" docs/images/inspect.png
mv "$work/page/program.png" docs/images/report.png
mv "$work/page/failed_check.png" docs/images/failed_check.png
mv "$work/page/dark.png" docs/images/dark.png
