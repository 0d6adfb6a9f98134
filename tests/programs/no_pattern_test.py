#!/usr/bin/env python3
"""What a run says and does where a body has patterns and none can be wound.

no_pattern_test.py PROGRAM PROJECT
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM, PROJECT = sys.argv[1], Path(sys.argv[2])


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        pipe, machine, job, out = (folder / name for name in ("pipe.stl", "short.json", "job.json", "out"))
        assert run("make", "cylinder", "--radius", 8, "--length", 41, "--edge", 2, "-o", pipe).returncode == 0
        short = json.loads((PROJECT / "machines/six_axis.json").read_text())
        short["eye_chain"][0].update(min=-25, max=25)  # the carriage does not come past the ends
        machine.write_text(json.dumps(short))
        # A wall of 2061 mm^2: 51,500 squares of this tow.
        job.write_text(json.dumps({"tow": {"width": 0.2, "thickness": 0.05, "friction": 0.3},
                                   "layers": [{"kind": "auto", "angle": 50}]}))
        done = run(pipe, "--machine", machine, "--job", job, "-o", out)
        assert done.returncode == 1, done
        report = json.loads((out / "report.json").read_text())
        failure = report["plan"]["failure"]
        assert not report["checks"]["plan"]["ok"] and report["plan"]["planner"] == "pattern", report["plan"]
        assert "0.002 m2" in failure and "0.2 mm" in failure, failure
        assert failure in done.stderr, done.stderr
        assert not (out / "program.ngc").exists()
        # The cover that was tried before took minutes; planning a pattern takes seconds.
        assert "library" not in done.stderr, done.stderr
    print("ok")


if __name__ == "__main__":
    main()
