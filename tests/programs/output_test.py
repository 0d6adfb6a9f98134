"""What is left in an output folder, whatever ends a run: no program but what its report describes."""
import fcntl
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

import program

EXTENSIONS = {"linuxcnc": ".ngc", "fanuc": ".nc", "siemens": ".mpf", "grbl": ".gcode",
              "marlin": ".gcode", "pulses": ".pulses", "rapid": ".mod", "krl": ".src", "tp": ".ls"}
HOOPS = '{"tow": {"width": 12}, "mandrel": {"extension": 0}, "layers": [{"kind": "hoop"}]}'
# Slips off: the plan is made and a check fails.
SLIPS = HOOPS.replace("12", '12, "friction": 0.001')

class OutputTest(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.mandrel = self.make("cylinder", "--radius", "40", "--length", "60", "--edge", "15")
        self.hoops = self.write("hoops.json", HOOPS)
        self.slips = self.write("slips.json", SLIPS)
        self.out = self.folder / "out"

    def machine(self, dialect):
        machine = json.loads((program.SOURCE / "machines/six_axis.json").read_text())
        machine["controller"] = {"dialect": dialect}
        return self.write(dialect + ".json", json.dumps(machine))

    def wind(self, job, *arguments):
        return self.run_program(self.mandrel, "--job", job, "-o", self.out, "--quiet", *arguments)

    def programs(self):
        return sorted(p.name for p in self.out.iterdir() if p.suffix in EXTENSIONS.values())

    def names(self):
        return sorted(p.name for p in self.out.iterdir())

    def popen(self, *arguments, environment=None, **options):
        process = subprocess.Popen([program.PROGRAM, *map(str, arguments)], cwd=self.folder,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True,
                                   env={**os.environ, **(environment or {})}, **options)
        self.addCleanup(process.kill)
        return process

    def begin_a_long_run(self, *options, **kinds):
        """A run that has the folder, and keeps it for seconds."""
        run = self.popen(program.SOURCE / "data/tee.stl", "-o", self.out, *options, **kinds)
        deadline = time.monotonic() + program.TIMEOUT_S
        while not self.out.exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(0.5)
        return run

    def short_axis(self):
        """The first 60 mm of the L frame: planned in no time, written by as many calls."""
        table = (program.SOURCE / "data/l_frame_axis.csv").read_text().splitlines(keepends=True)
        return self.write("axis.csv", "".join(table[:8]))


class StalePrograms(OutputTest):
    def stale(self):
        """What runs of all kinds could have left, and what is nobody's but the user's."""
        self.out.mkdir(exist_ok=True)
        stale = ["program" + suffix + extension for extension in set(EXTENSIONS.values())
                 for suffix in ("", "-2", "-layer-2", "-layer-12-3")]
        stale += ["mine.src", "mine_back.src", "rings.csv", "fibre.csv", "verify.json", "verify.html", "laid.csv"]
        for name in stale:
            (self.out / name).write_text("stale")
        (self.out / "report.json").write_text(
            '{"program": {"dialect": "krl", "file": "mine.src"}, "ok": true}')
        kept = ["own.ngc", "program.txt", "other.src", "program-x.nc", "notes.json"]
        for name in kept:
            (self.out / name).write_text("kept")
        return stale, kept

    def check(self, stale, kept, written):
        left = self.names()
        for name in stale:
            if (self.out / name).exists():
                self.assertIn(name, written)
                self.assertNotEqual((self.out / name).read_text(), "stale", name)
        for name in kept:
            self.assertEqual((self.out / name).read_text(), "kept", name)
        self.assertFalse([name for name in left if name.startswith(".")])

    def test_a_run_that_fails_leaves_no_program(self):
        stale, kept = self.stale()
        result = self.wind(self.slips)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.check(stale, kept, [])
        self.assertFalse(json.loads((self.out / "report.json").read_text())["ok"])

    def test_a_good_run_leaves_its_own_program_alone(self):
        for dialect in ("linuxcnc", "siemens", "fanuc"):
            with self.subTest(dialect):
                stale, kept = self.stale()
                result = self.wind(self.hoops, "--machine", self.machine(dialect))
                self.assertEqual(result.returncode, 0, result.stderr)
                report = json.loads((self.out / "report.json").read_text())
                own = report["program"]["file"]
                self.assertEqual(own, "program" + EXTENSIONS[dialect])
                self.check(stale, kept, [own])

    def test_carry_and_the_main_job_take_each_other_s_programs_away(self):
        carry = ["carry", self.short_axis(), "-o", self.out, "--quiet"]
        self.done(*carry, "--name", "frame")
        self.assertEqual(self.programs(), ["frame.src", "frame_back.src"])
        report = json.loads((self.out / "report.json").read_text())
        self.assertEqual(report["program"]["file"], "frame.src")
        self.assertEqual(report["program"]["back_file"], "frame_back.src")
        self.done(*carry, "--name", "bend", "--angle", "0")
        self.assertEqual(self.programs(), ["bend.src"])
        self.assertEqual(self.wind(self.hoops).returncode, 0)
        self.assertEqual(self.programs(), ["program.ngc"])
        self.assertFalse((self.out / "rings.csv").exists())
        self.done(*carry, "--name", "frame")
        self.assertEqual(self.programs(), ["frame.src", "frame_back.src"])

    def test_post_takes_the_main_job_s_programs_away(self):
        self.assertEqual(self.wind(self.hoops, "--machine", self.machine("siemens")).returncode, 0)
        points = self.write("points.csv", (self.out / "path.csv").read_text())
        result = self.run_program("post", points, "--mandrel", self.mandrel, "--machine",
                                  "six_axis.json", "--job", self.hoops, "--frame", "mandrel", "-o",
                                  self.out, "--quiet")
        self.assertIn(result.returncode, (0, 1), result.stderr)
        self.assertEqual(self.programs(), ["program.ngc"] if result.returncode == 0 else [])

    def test_verify_and_study_leave_program_and_report_alone(self):
        self.assertEqual(self.wind(self.hoops).returncode, 0)
        before = {p.name: p.read_bytes() for p in self.out.iterdir()}
        self.run_program("verify", self.out / "program.ngc", "--mandrel", self.mandrel, "--machine",
                         "six_axis.json", "--job", self.hoops, "-o", self.out, "--quiet")
        self.run_program("study", "mesh-size", "--mandrel", "cylinder", "--edges", "20,10",
                         "--paths", "2", "-o", self.out, "--quiet")
        after = {p.name: p.read_bytes() for p in self.out.iterdir()}
        self.assertEqual({name: after.get(name) for name in before}, before)
        self.assertIn("verify.json", after)
        # The next program is not the one that was verified.
        self.assertEqual(self.wind(self.hoops).returncode, 0)
        self.assertNotIn("verify.json", self.names())


class Locked(OutputTest):
    def test_a_folder_that_another_run_has_is_refused(self):
        self.out.mkdir()
        (self.out / "program.ngc").write_text("other")
        descriptor = os.open(self.out, os.O_RDONLY)
        self.addCleanup(os.close, descriptor)
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        study = ["study", "mesh-size", "--mandrel", "torus", "-o", self.out]
        carry = ["carry", program.SOURCE / "data/l_frame_axis.csv", "-o", self.out]
        (self.out / "program.ngc").write_text("M2\n")
        for arguments in ([self.mandrel, "-o", self.out], study, carry):
            with self.subTest(arguments[0]):
                result = self.run_program(*arguments, "--quiet", "--json")
                self.assertEqual(result.returncode, 2)
                self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
                self.assertEqual(json.loads(result.stdout)["error"]["code"], "output.locked")
                self.assertIn("-o", result.stderr)
        self.assertEqual(self.names(), ["program.ngc"])

    def test_two_runs_into_one_folder(self):
        first = self.begin_a_long_run()
        second = self.wind(self.hoops, "--json")
        self.assertEqual(second.returncode, 2, second.stderr)
        self.assertEqual(json.loads(second.stdout)["error"]["code"], "output.locked")
        first.send_signal(signal.SIGTERM)
        first.communicate(timeout=program.TIMEOUT_S)
        self.assertFalse(self.out.exists())
        self.assertEqual(self.wind(self.hoops).returncode, 0)

    def test_a_killed_run_holds_nothing(self):
        first = self.begin_a_long_run()
        first.kill()
        first.communicate(timeout=program.TIMEOUT_S)
        self.assertEqual(self.wind(self.hoops).returncode, 0)


class Ended(OutputTest):
    """Runs that end before their time."""

    def leftovers(self):
        return [p.name for p in self.out.iterdir() if p.name.startswith(".")]

    def described(self):
        """Each program is of the run whose report stands beside it."""
        report = self.out / "report.json"
        for name in self.programs():
            self.assertTrue(report.exists(), name)
            self.assertEqual(json.loads(report.read_text())["program"]["file"], name)

    def test_killed_or_refused_at_any_call_of_the_system(self):
        siemens = self.machine("siemens")
        carry = ["carry", self.short_axis(), "-o", self.out, "--quiet"]
        self.assertEqual(self.wind(self.hoops, "--machine", siemens).returncode, 0)
        first = {p.name: p.read_bytes() for p in self.out.iterdir()}
        for fault in ("kill", "once"):
            n, reached = 0, True
            while reached:
                n += 1
                with self.subTest(fault=fault, n=n):
                    shutil.rmtree(self.out)
                    self.out.mkdir()
                    for name, content in first.items():
                        (self.out / name).write_bytes(content)
                    tell = self.folder / "reached"
                    process = self.popen(*carry, environment={
                        "LD_PRELOAD": program.FAULTS, "MESHWIND_FAULT": f"{fault}:{n}",
                        "MESHWIND_FAULT_FILE": str(tell)})
                    _, err = process.communicate(timeout=program.TIMEOUT_S)
                    after = {p.name: p.read_bytes() for p in self.out.iterdir()}
                    reached = tell.exists()
                    tell.unlink(missing_ok=True)
                    for name in self.programs():
                        described = json.loads(after["report.json"])["program"]
                        self.assertIn(name, (described["file"], described.get("back_file")))
                    if process.returncode == 2:
                        self.assertEqual(len(err.splitlines()), 1, err)
                        self.assertEqual(after, first)
                    else:
                        self.assertIn(process.returncode, (0, -signal.SIGKILL), err)
            self.assertGreater(n, 20)

    def test_leftovers_of_a_killed_run_are_removed_by_the_next(self):
        self.assertEqual(self.wind(self.hoops).returncode, 0)
        process = self.popen(self.mandrel, "--job", self.hoops, "-o", self.out, environment={
            "LD_PRELOAD": program.FAULTS, "MESHWIND_FAULT": "kill:9"})
        process.communicate(timeout=program.TIMEOUT_S)
        self.assertEqual(process.returncode, -signal.SIGKILL)
        self.assertTrue(self.leftovers())
        (self.out / ".mine.tmp").write_text("mine")
        self.assertEqual(self.wind(self.hoops).returncode, 0)
        self.assertEqual(self.leftovers(), [".mine.tmp"])

    def test_signals_end_a_run_and_leave_nothing(self):
        for number in (signal.SIGHUP, signal.SIGXCPU, signal.SIGXFSZ, signal.SIGPIPE):
            with self.subTest(number=number):
                process = self.begin_a_long_run(preexec_fn=listen)
                _, err = self.ended_by(process, number)
                self.assertEqual(process.returncode, 128 + number, err)
                self.assertEqual(sorted(self.folder.iterdir()),
                                 sorted([self.mandrel, self.hoops, self.slips]))

    def test_a_crash_is_one_line_and_leaves_nothing(self):
        for number in (signal.SIGSEGV, signal.SIGBUS, signal.SIGFPE, signal.SIGILL,
                       signal.SIGABRT):
            with self.subTest(number=number):
                process = self.begin_a_long_run("--quiet")
                process.send_signal(number)
                _, err = process.communicate(timeout=program.TIMEOUT_S)
                self.assertEqual(process.returncode, 3, err)
                self.assertEqual(len(err.splitlines()), 1, err)
                self.assertTrue(err.startswith("meshwind: internal error: "), err)
                self.assertFalse(self.out.exists())

    def test_a_file_larger_than_the_shell_allows(self):
        self.assertEqual(self.wind(self.hoops).returncode, 0)
        before = {p.name: p.read_bytes() for p in self.out.iterdir()}

        def limit():
            listen()
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        result = self.popen(self.mandrel, "--job", self.hoops, "-o", self.out, "--quiet",
                            preexec_fn=limit)
        _, err = result.communicate(timeout=program.TIMEOUT_S)
        self.assertEqual(result.returncode, 128 + signal.SIGXFSZ, err)
        self.assertEqual(len(err.splitlines()), 1, err)
        self.assertIn("ulimit -f", err)
        self.assertEqual({p.name: p.read_bytes() for p in self.out.iterdir()}, before)

    def in_a_mount(self, options, inside):
        """`inside` in a shell that has a file system of its own at out; skipped without the rights."""
        self.out.mkdir(exist_ok=True)
        mount = f"mount -t tmpfs -o {options} none {self.out}"
        tried = subprocess.run(["unshare", "-rm", "sh", "-c", mount], capture_output=True)
        if tried.returncode != 0:
            self.skipTest("no rights to mount a file system")
        return subprocess.run(["unshare", "-rm", "sh", "-c", mount + " && " + inside],
                              cwd=self.folder, capture_output=True, text=True, timeout=program.TIMEOUT_S)

    def test_a_full_disk(self):
        run = f"'{program.PROGRAM}' '{self.mandrel}' --job '{self.hoops}' -o out --quiet"
        small = run + "; echo code $?; ls -A out"
        result = self.in_a_mount("size=100k", small)
        self.assertEqual(result.stdout, "code 2\n", result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn("No space left", result.stderr)
        grown = (run + " && (cd out && md5sum *) > before; "
                 "head -c 60000000 /dev/zero > out/filler 2>/dev/null; " + run +
                 "; echo code $?; rm out/filler; cd out && md5sum --quiet -c ../before && ls -A")
        result = self.in_a_mount("size=50m", grown)
        lines = result.stdout.splitlines()
        self.assertEqual(lines[0], "code 2", result.stdout + result.stderr)
        self.assertIn("program.ngc", lines)
        self.assertFalse([name for name in lines if name.startswith(".")])

    def test_a_read_only_folder(self):
        run = (f"mount -o remount,ro none out && '{program.PROGRAM}' '{self.mandrel}' --job "
               f"'{self.hoops}' -o out --quiet; echo code $?; ls -A out")
        result = self.in_a_mount("size=1m", run)
        self.assertEqual(result.stdout, "code 2\n", result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)

    def test_closed_streams(self):
        for closed in ("0<&-", "1>&-", "2>&-", "0<&- 1>&- 2>&-"):
            with self.subTest(closed):
                shutil.rmtree(self.out, ignore_errors=True)
                run = (f"'{program.PROGRAM}' '{self.mandrel}' --job '{self.hoops}' -o out "
                       f"{closed}; echo code $?")
                result = subprocess.run(["sh", "-c", run], cwd=self.folder, capture_output=True,
                                        text=True, timeout=program.TIMEOUT_S)
                self.assertEqual(result.stdout.splitlines()[-1], "code 0", result.stderr)
                self.assertEqual(self.programs(), ["program.ngc"])
                for file in self.out.iterdir():
                    text = file.read_bytes()
                    self.assertNotIn(b"import ...", text, file.name)
                    self.assertNotIn(b"  ok      ", text, file.name)


class Shown(OutputTest):
    """What is shown arrives or the exit code says that it has not."""

    def commands(self):
        self.assertEqual(self.wind(self.hoops).returncode, 0)
        setup = ["--mandrel", self.mandrel, "--machine", "six_axis.json", "--job", self.hoops]
        return (["--help"], ["--version"], ["wind", "--help"], ["inspect", self.mandrel],
                ["inspect", self.mandrel, "--json"], ["validate", self.hoops],
                ["verify", self.out / "program.ngc", *setup, "--json"],
                ["verify", self.out / "program.ngc", *setup],
                ["make", "cylinder", "-o", "a.stl"],
                ["design", "vessel", "--radius", "40", "--length", "80", "--opening", "15"],
                [self.mandrel, "--job", self.hoops, "-o", "more", "--json", "--quiet"])

    def test_full_device(self):
        for arguments in self.commands():
            with self.subTest(arguments[:3]), open("/dev/full", "w") as full:
                result = subprocess.run([program.PROGRAM, *map(str, arguments)], cwd=self.folder,
                                        stdin=subprocess.DEVNULL, stdout=full,
                                        stderr=subprocess.PIPE, text=True, timeout=program.TIMEOUT_S)
                self.assertEqual(result.returncode, 3, result.stderr)
                lines = [line for line in result.stderr.splitlines() if "standard output" in line]
                self.assertEqual(len(lines), 1, result.stderr)
                self.assertIn("No space left on device", lines[0])

    def test_closed_pipe(self):
        for arguments in self.commands():
            with self.subTest(arguments[:3]):
                reader, writer = os.pipe()
                os.close(reader)
                result = subprocess.run([program.PROGRAM, *map(str, arguments)], cwd=self.folder,
                                        stdin=subprocess.DEVNULL, stdout=writer,
                                        stderr=subprocess.PIPE, text=True, timeout=program.TIMEOUT_S,
                                        preexec_fn=listen)
                os.close(writer)
                self.assertEqual(result.returncode, 128 + signal.SIGPIPE, result.stderr)
                self.assertFalse([line for line in result.stderr.splitlines()
                                  if line.startswith("meshwind: ")])


def listen():
    """As a shell's foreground job: whoever started the tests may ignore signals."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGXFSZ, signal.SIGXCPU,
                   signal.SIGPIPE):
        signal.signal(number, signal.SIG_DFL)


if __name__ == "__main__":
    program.FAULTS = os.path.abspath(sys.argv.pop(3))
    program.main("__main__")
