#!/usr/bin/env python3
"""bench/scale.py PROGRAM [--what KINDS] [--factors LIST] [--threads N] [--out FILE]: how time and
memory of each phase grow, from 1 to 100 times the size, with the exponent fitted to them.

KINDS, by commas: make, inspect, refine, trace (all of a tee, by triangles), job (the main job on
that tee, by triangles), length (a pipe with a helical layer that becomes longer), tows (a vessel
that becomes wider: more tows across; both on six_axis.json with longer ways, by metres of fibre,
which a program tells block by block). A case that takes longer than --limit seconds ends its row:
larger ones are left out. Time is CPU time of a whole command, of a phase the clock's; memory is the
peak, of a phase the largest seen while it ran. Phases with an exponent above 1.15 are listed at the
end: n log n has 1.1 between 10^4 and 10^6. MESHWIND_HOME as for the program. Exit 1 where a phase
grows faster.
"""

import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

TEE_AREA_MM2 = 168588.0
TEE_TRIANGLES = 10_000  # at factor 1
EQUILATERAL = math.sqrt(3.0) / 4.0
PIPE_LENGTH_MM = 120.0
VESSEL_RADIUS_MM = 20.0
LONG_WAYS_MM = {"Z": (-8000.0, 8000.0), "X": (0.0, 3000.0), "Y": (-3000.0, 3000.0)}
LONG_FREE_MM = 2500.0
FASTEST = 1.15  # exponent
LEAST_S = 0.05  # shorter times are not fitted
SAMPLE_S = 0.02


class Watch(threading.Thread):
    """Notes when a process tells of a new phase, and how much memory it has in each."""

    def __init__(self, process):
        super().__init__(daemon=True)
        self.process = process
        self.phase = "start"
        self.phases = {}
        self.peak_mb = {}
        self.words = []

    def note(self, text, since):
        now = time.monotonic()
        self.phases[self.phase] = self.phases.get(self.phase, 0.0) + now - since
        self.phase = text
        return now

    def sample(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/statm")
        page_mb = os.sysconf("SC_PAGE_SIZE") / 1e6
        while self.process.returncode is None:
            try:
                resident_mb = int(status.read_text().split()[1]) * page_mb
            except (OSError, IndexError):
                return
            self.peak_mb[self.phase] = max(self.peak_mb.get(self.phase, 0.0), resident_mb)
            time.sleep(SAMPLE_S)

    def run(self):
        threading.Thread(target=self.sample, daemon=True).start()
        since = time.monotonic()
        for line in self.process.stderr:
            words = line.strip()
            self.words.append(words)
            if words.endswith("...") and not words[0].isdigit():
                name = words.split(" ...")[0].rstrip("0123456789 %,:left").split(",")[0].strip()
                if name and name != self.phase:
                    since = self.note(name, since)
        self.note("end", since)


def run(command, limit_s):
    """CPU seconds, clock seconds, peak MB, phases of a command; None where it takes too long."""
    begin = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    timer = threading.Timer(limit_s, process.terminate)
    timer.start()
    watch = Watch(process)
    watch.start()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    timer.cancel()
    watch.join(5.0)
    if process.returncode not in (0, 1):
        if time.monotonic() - begin < limit_s:
            sys.exit(" ".join(command) + "\n" + "\n".join(watch.words))
        return None
    return {"cpu_s": usage.ru_utime + usage.ru_stime, "clock_s": time.monotonic() - begin,
            "peak_mb": usage.ru_maxrss / 1e3, "exit": process.returncode, "phases_s": watch.phases,
            "phases_mb": watch.peak_mb}


class Bench:
    def __init__(self, arguments, folder):
        self.program = [arguments.program, "--threads", str(arguments.threads)]
        self.limit_s = arguments.limit
        self.folder = folder

    def tee(self, factor):
        """The tee with so many times the triangles, and how long it took to make it."""
        triangles = TEE_TRIANGLES * factor
        edge_mm = math.sqrt(TEE_AREA_MM2 / (EQUILATERAL * triangles))
        file = self.folder / f"tee-{factor}.stl"
        made = None
        if not file.exists():
            made = run([*self.program, "make", "tee", "--edge", f"{edge_mm:.4f}", "-o", str(file)],
                       self.limit_s)
        return file, edge_mm, triangles, made

    def make(self, factor):
        file, _, triangles, _ = self.tee(factor)
        file.unlink(missing_ok=True)
        return triangles, self.tee(factor)[3]

    def inspect(self, factor):
        file, _, triangles, _ = self.tee(factor)
        return triangles, run([*self.program, "inspect", str(file), "--units", "mm"], self.limit_s)

    def refine(self, factor):
        file, _, _, _ = self.tee(1)
        edge_mm = math.sqrt(TEE_AREA_MM2 / (EQUILATERAL * TEE_TRIANGLES * factor))
        return TEE_TRIANGLES * factor, run(
            [*self.program, "inspect", str(file), "--units", "mm", "--refine", f"{edge_mm:.4f}", "-o",
             str(self.folder / "refined.stl")], self.limit_s)

    def trace(self, factor):
        file, _, triangles, _ = self.tee(factor)
        return triangles, run(
            [*self.program, "trace", str(file), "--units", "mm", "--start", "0,-50,0", "--angle", "62",
             "-o", str(self.folder / "trace.csv")], self.limit_s)

    def large_machine(self):
        """six_axis.json with ways for parts of 12 m."""
        home = pathlib.Path(os.environ.get("MESHWIND_HOME", "."))
        machine = json.loads((home / "machines" / "six_axis.json").read_text())
        for axis in machine["eye_chain"]:
            if axis["letter"] in LONG_WAYS_MM:
                axis["min"], axis["max"] = LONG_WAYS_MM[axis["letter"]]
        machine["fibre"]["max_free_length"] = LONG_FREE_MM
        file = self.folder / "large.json"
        file.write_text(json.dumps(machine))
        return file

    def wind(self, mandrel, job, machine="six_axis.json"):
        """The main job, with the phases of its report in place of those it told."""
        job_file = self.folder / "job.json"
        job_file.write_text(json.dumps(job))
        out = self.folder / "out"
        found = run([*self.program, str(mandrel), "--machine", str(machine), "--job", str(job_file),
                     "-o", str(out)], self.limit_s)
        if found:
            report = json.loads((out / "report.json").read_text())
            found["fibre_m"] = report["plan"]["fibre_length_mm"] / 1e3
            timing = report["timing_s"]
            for stage in ("post", "verify", "import"):
                found["phases_s"].pop(stage, None)
            told = {f"report {stage}": seconds for stage, seconds in timing.items()}
            found["phases_s"].update(told)
            found["phases_s"]["page and publishing"] = max(0.0, found["clock_s"] - timing["total"])
        return found

    def job(self, factor):
        file, _, triangles, _ = self.tee(factor)
        return triangles, self.wind(file, {"mandrel": {"units": "mm"}})

    def by_fibre(self, mandrel, job):
        found = self.wind(mandrel, job, self.large_machine())
        return found["fibre_m"] if found else math.inf, found

    def length(self, factor):
        length_mm = PIPE_LENGTH_MM * factor
        file = self.folder / "pipe.stl"
        run([*self.program, "make", "cylinder", "--radius", "50", "--length", str(length_mm), "-o",
             str(file)], self.limit_s)
        job = {"mandrel": {"units": "mm"}, "tow": {"width": 3.0},
               "layers": [{"kind": "helical", "angle": 50}]}
        return self.by_fibre(file, job)

    def tows(self, factor):
        radius_mm = VESSEL_RADIUS_MM * factor
        file = self.folder / "vessel.stl"
        run([*self.program, "make", "vessel", "--radius", str(radius_mm), "--cylinder-length",
             str(2.0 * radius_mm), "--dome-height", str(0.7 * radius_mm), "--opening-radius",
             str(0.25 * radius_mm), "--edge", str(max(2.0, radius_mm / 20.0)), "-o", str(file)],
            self.limit_s)
        job = {"mandrel": {"units": "mm"}, "tow": {"width": 6.0}, "layers": [{"kind": "polar"}]}
        return self.by_fibre(file, job)


def exponent(points):
    """Slope of log(value) over log(size), by least squares; None for fewer than two."""
    logs = [(math.log(size), math.log(value)) for size, value in points if value > 0.0]
    if len(logs) < 2:
        return None
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    spread = sum((x - mean_x) ** 2 for x, _ in logs)
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / spread if spread > 0.0 else None


def print_rows(kind, rows):
    """Prints a table; returns the phases that grow faster than n log n."""
    columns = {"CPU": [(size, found["cpu_s"]) for size, found in rows],
               "clock": [(size, found["clock_s"]) for size, found in rows]}
    for phase in sorted({name for _, found in rows for name in found["phases_s"]} - {"start", "end"}):
        columns[phase] = [(size, found["phases_s"].get(phase, 0.0)) for size, found in rows]
    memory = [(size, found["peak_mb"]) for size, found in rows]
    print(f"\n{kind}: size " + " ".join(f"{size:11.0f}" for size, _ in rows) + "   exponent")
    fast = []
    for name, points in columns.items():
        fitted = exponent([(size, value) for size, value in points if value >= LEAST_S])
        cells = " ".join(f"{value:9.2f} s" for _, value in points)
        print(f"{name:24} {cells}   " + ("-" if fitted is None else f"{fitted:.2f}"))
        if fitted is not None and fitted > FASTEST and len(points) > 2:
            fast.append(f"{kind}: {name}, n^{fitted:.2f}")
    fitted = exponent(memory)
    print(f"{'peak memory':24} " + " ".join(f"{value:8.0f} MB" for _, value in memory) + "   " +
          ("-" if fitted is None else f"{fitted:.2f}"))
    for phase in sorted({name for _, found in rows for name in found["phases_mb"]}):
        cells = " ".join(f"{found['phases_mb'].get(phase, 0.0):8.0f} MB" for _, found in rows)
        print(f"  {phase:22} {cells}")
    return fast


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--what", default="make,inspect,refine,trace,job,length,tows")
    parser.add_argument("--factors", default="1,3,10,30,100")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--limit", type=float, default=600.0)
    parser.add_argument("--out", type=pathlib.Path)
    arguments = parser.parse_args()
    fast = []
    results = {}
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(arguments, pathlib.Path(folder))
        for kind in arguments.what.split(","):
            rows = []
            for factor in [int(text) for text in arguments.factors.split(",")]:
                size, found = getattr(bench, kind)(factor)
                if found is None:
                    print(f"{kind}: factor {factor} takes more than {arguments.limit:.0f} s", file=sys.stderr)
                    break
                rows.append((size, found))
            if rows:
                fast += print_rows(kind, rows)
            results[kind] = [{"size": size, **found} for size, found in rows]
    if arguments.out:
        arguments.out.write_text(json.dumps(results, indent=1))
    print("\nfaster than n log n: " + ("; ".join(fast) if fast else "nothing"))
    sys.exit(1 if fast else 0)


if __name__ == "__main__":
    main()
