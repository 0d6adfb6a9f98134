#!/usr/bin/env python3
"""Compares an NC program, as LinuxCNC's interpreter executes it, with its motion table.

    check_program.py program.ngc motion.csv machine.json

Every block's absolute position must lie within half a resolution step of the table's row, the feed
moves must be as many as the table's rows after the start, the start must be where the rapid moves
end, and the time of every G93 block, recomputed from the interpreter's feed, must be that of the
table (this finds the feed floor of old interpreters). Exit 0 agrees, 1 differs, 2 usage, 77 the
interpreter is unavailable (see run_rs274.sh).
"""
import csv
import json
import math
import pathlib
import subprocess
import sys

# Nine printed decimals of sums over many blocks, on top of half a step.
SLACK = 1e-7
# F carries six digits and the table's time six decimals.
TIME_SLACK_RELATIVE = 2e-5
TIME_SLACK_S = 2e-6
# The interpreter runs nothing slower; a block this slow that does not turn is merely quicker.
FEED_FLOOR = 0.1


def interpreter_rows(program):
    """Rows of run_rs274.sh as dictionaries."""
    tool = pathlib.Path(__file__).with_name("run_rs274.sh")
    run = subprocess.run([str(tool), str(program)], stdout=subprocess.PIPE, text=True, check=False)
    if run.returncode != 0:
        print(f"{program}: the interpreter gave exit code {run.returncode}")
        sys.exit(77 if run.returncode == 77 else 1)
    return list(csv.DictReader(run.stdout.splitlines()))


def path_length(before, after):
    """Length that the interpreter multiplies with F: XYZ, else UVW, else ABC."""
    for letters in ("xyz", "uvw", "abc"):
        length = math.sqrt(sum((after[c] - before[c]) ** 2 for c in letters))
        if length > 1e-7:
            return length
    return 0.0


def main():
    if len(sys.argv) != 4:
        print(__doc__, file=sys.stderr)
        return 2
    program, motion, machine = (pathlib.Path(name) for name in sys.argv[1:])
    profile = json.loads(machine.read_text(encoding="utf-8"))
    steps = {axis["letter"]: axis["resolution"]
             for axis in profile["mandrel_chain"] + profile["eye_chain"]}
    with motion.open(encoding="utf-8", newline="") as stream:
        plan = list(csv.DictReader(stream))
    moves = [{key: (value if key == "kind" else float(value)) for key, value in row.items()}
             for row in interpreter_rows(program)]
    rapids = [row for row in moves if row["kind"] == "T"]
    feeds = [row for row in moves if row["kind"] == "F"]
    wrong = []
    if len(feeds) + 1 != len(plan):
        wrong.append(f"{len(feeds)} feed moves, the table has {len(plan)} rows with the start")
    if not rapids or moves.index(rapids[-1]) != len(rapids) - 1:
        wrong.append("rapid moves are not all before the first feed move")
    executed = rapids[-1:] + feeds
    worst = dict.fromkeys(steps, 0.0)
    for i, (row, want) in enumerate(zip(executed, plan)):
        for letter, step in steps.items():
            error = abs(row[letter.lower()] - float(want[letter]))
            worst[letter] = max(worst[letter], error)
            if error > 0.5 * step + SLACK:
                wrong.append(f"block {i}, line {row['line']:.0f}: {letter} is off by {error:.9f}")
        if i == 0:
            continue
        before = executed[i - 1]
        planned_s = float(want["time_s"]) - float(plan[i - 1]["time_s"])
        length = path_length(before, row)
        turns = any(row[c] != before[c] for c in "abc")
        if length and row["feed"] > 0.0 and (turns or row["feed"] > 1.01 * FEED_FLOOR):
            seconds = 60.0 * length / row["feed"]
            floor = length * 60.0 / planned_s < FEED_FLOOR if planned_s > 0 else False
            only_turns = path_length({**before, "a": 0, "b": 0, "c": 0},
                                     {**row, "a": 0, "b": 0, "c": 0}) == 0.0
            if floor and only_turns:
                continue  # a turn slower than 0.1 deg/min
            if abs(seconds - planned_s) > TIME_SLACK_RELATIVE * planned_s + TIME_SLACK_S:
                wrong.append(f"block {i}, line {row['line']:.0f}: takes {seconds:.6f} s, "
                             f"planned {planned_s:.6f} s")
    for line in wrong[:20]:
        print(line)
    text = ", ".join(f"{letter} {error:.2e}" for letter, error in worst.items())
    print(f"{program}: {len(feeds)} blocks, {len(wrong)} differences, largest errors {text}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
