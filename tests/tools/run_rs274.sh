#!/bin/bash
# Runs an NC program through LinuxCNC's own RS274/NGC interpreter, without installing LinuxCNC.
#
#   run_rs274.sh --setup             fetch and unpack the interpreter (Debian 12, amd64; no root)
#   run_rs274.sh PROGRAM > moves.csv one row per straight move: line,kind,feed,x,y,z,a,b,c,u,v,w
#
# kind is F (feed) or T (rapid). Positions are absolute, mm and degrees, 9 decimals, as the interpreter
# adds them up; feed is mm/min or deg/min, in G93 the interpreter's length * F.
# RS274_ROOT chooses the folder of the unpacked interpreter (default ~/.cache/meshwind-rs274).
#
# Exit: 0 done; 1 the interpreter refuses the program ("FILE:LINE: words" on stderr); 2 usage;
#       3 a move that this script does not print (arc, probe, tap); 77 the interpreter is unavailable.
set -u
root=${RS274_ROOT:-${XDG_CACHE_HOME:-$HOME/.cache}/meshwind-rs274}
python=/usr/bin/python3   # Debian's own: the interpreter's module is built for it
modules=usr/lib/python3/dist-packages

stop() { echo "run_rs274: $2" >&2; exit "$1"; }

setup() {
    [ -e "$root/ready" ] && exit 0
    if ! command -v dpkg >/dev/null || ! command -v apt-get >/dev/null; then
        stop 77 "interpreter unavailable: this is not a Debian system"
    fi
    [ "$(dpkg --print-architecture)" = amd64 ] || stop 77 "interpreter unavailable: not amd64"
    local work; work=$(mktemp -d) || exit 2
    trap 'rm -rf "$work"' EXIT
    cd "$work" || exit 2
    apt-get -qq download linuxcnc-uspace libboost-python1.74.0 2>/dev/null ||
        stop 77 "interpreter unavailable: apt-get download linuxcnc-uspace failed"
    for package in *.deb; do dpkg -x "$package" x || stop 77 "interpreter unavailable: bad package"; done
    mkdir -p "$root" || exit 2
    cd x || exit 2
    tar cf - usr/lib/*.so.0 usr/lib/*/libboost_python311.so.* $modules/gcode.*.so \
        $modules/rs274/__init__.py $modules/rs274/interpret.py | tar xf - -C "$root" ||
        stop 77 "interpreter unavailable: the package has another layout"
    : > "$root/ready"
    exit 0
}

[ $# = 1 ] || { sed -n '2,15s/^# \?//p' "$0" >&2; exit 2; }
[ "$1" = --setup ] && setup
[ -r "$1" ] || stop 2 "cannot read $1"
[ -e "$root/ready" ] || stop 77 "interpreter unavailable: run $0 --setup first"

# Offsets and tools outlive a run in these files: every run gets fresh ones.
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
: > "$work/parameters"
export HOME=$work LD_LIBRARY_PATH=$root/usr/lib:$root/usr/lib/x86_64-linux-gnu PYTHONPATH=$root/$modules
$python - "$1" "$work/parameters" <<'PYTHON'
import sys

try:
    import gcode
    from rs274.interpret import Translated
except ImportError as error:
    sys.stderr.write("run_rs274: interpreter unavailable: %s\n" % error)
    sys.exit(77)

INCH = 25.4  # the module reports lengths in inches
UNITS = (INCH, INCH, INCH, 1.0, 1.0, 1.0, INCH, INCH, INCH)
program = sys.argv[1]


class Moves(Translated):
    """Receives the interpreter's canonical commands."""

    parameter_file = sys.argv[2]

    def __init__(self):
        self.line = 0
        self.feed = 0.0
        self.unprinted = 0

    def next_line(self, state):
        self.line = state.sequence_number

    def set_feed_rate(self, feed):
        self.feed = feed * INCH

    def row(self, kind, feed, position):
        cells = ["%.9f" % (value * unit + 0.0) for value, unit in zip(position, UNITS)]
        sys.stdout.write("%d,%s,%.9g,%s\n" % (self.line, kind, feed, ",".join(cells)))

    def straight_feed_translated(self, *position):
        self.row("F", self.feed, position)

    def straight_traverse_translated(self, *position):
        self.row("T", 0.0, position)

    def unsupported(self, *_):
        self.unprinted = self.unprinted or self.line

    arc_feed = straight_probe = rigid_tap = unsupported

    def ignore(self, *_):
        pass

    message = comment = dwell = set_plane = set_traverse_rate = set_feed_mode = ignore
    change_tool = tool_offset = user_defined_function = ignore

    def get_tool(self, _pocket):
        return (-1,) + (0.0,) * 12 + (0,)

    def get_external_angular_units(self):
        return 1.0

    def get_external_length_units(self):
        return 1.0 / INCH

    def get_axis_mask(self):
        return 0x1FF

    def get_block_delete(self):
        return 0

    def check_abort(self):
        return 0


sys.stdout.write("line,kind,feed,x,y,z,a,b,c,u,v,w\n")
moves = Moves()
result, line = gcode.parse(program, moves, "G21", "G90 G17 G40 G49 G54 G80 G94")
if result > gcode.MIN_ERROR:
    sys.stderr.write("%s:%d: %s\n" % (program, line, gcode.strerror(result)))
    sys.exit(1)
if moves.unprinted:
    sys.stderr.write("%s:%d: arc, probe or tap\n" % (program, moves.unprinted))
    sys.exit(3)
PYTHON
