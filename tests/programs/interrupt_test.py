"""Ctrl-C leaves nothing half-written; progress is a bar on a terminal and never on stdout."""
import fcntl
import os
import pty
import signal
import struct
import subprocess
import termios
import time

import program

WIPE = "\r\033[K"
COLUMNS = 60


def listen_to_signals():
    """As a shell's foreground job: whoever started the tests may ignore them."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


class Interrupt(program.ProgramTest):
    def started(self, *arguments):
        return self.command(program.SOURCE / "data" / "tee.stl", *arguments)

    def command(self, *arguments):
        process = subprocess.Popen([program.PROGRAM, *arguments], cwd=self.folder,
                                   stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   preexec_fn=listen_to_signals)
        self.addCleanup(process.kill)
        return process

    def ended(self, process, number):
        out, err = self.ended_by(process, number)
        self.assertEqual(process.returncode, 128 + number, err)
        self.assertEqual(out, "")
        return err.splitlines()

    def test_ends_soon_and_leaves_nothing(self):
        for number, delay_s in ((signal.SIGINT, 1), (signal.SIGTERM, 2)):
            with self.subTest(number=number, delay_s=delay_s):
                process = self.started("-o", "a/out", "--png", "view.png")
                time.sleep(delay_s)
                lines = self.ended(process, number)
                self.assertEqual([line for line in lines if not line.endswith(" ...")],
                                 ["meshwind: interrupted; nothing unfinished is left"])
                self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_million_triangles_can_be_left(self):
        """Reading, repair and regions of so many take seconds."""
        mesh = self.make("cylinder", "--radius", "150", "--length", "1000", "--edge", "1.5")
        before = sorted(self.folder.iterdir())
        for arguments, delay_s in ((["inspect", mesh], 1),
                                   (["inspect", mesh, "--refine", "1", "-o", "fine.stl"], 3),
                                   (["trace", mesh, "--start", "150,0,0", "--angle", "45", "-o", "path.csv"], 2)):
            with self.subTest(command=arguments[0], delay_s=delay_s):
                process = self.command(*arguments)
                time.sleep(delay_s)
                lines = self.ended(process, signal.SIGTERM)
                self.assertEqual(lines, ["meshwind: interrupted; nothing unfinished is left"])
                self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_earlier_output_stays_as_it_was(self):
        out = self.folder / "out"
        out.mkdir()
        kept = {"report.json": "{}", "program.ngc": "M2\n", "mine.txt": "mine"}
        for name, text in kept.items():
            (out / name).write_text(text)
        process = self.started("-o", "out")
        time.sleep(1)
        self.ended(process, signal.SIGINT)
        self.assertEqual({p.name: p.read_text() for p in out.iterdir()}, kept)

    def test_second_signal_ends_at_once(self):
        process = self.started("-o", "a/out")
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        self.ended(process, signal.SIGINT)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_calls_without_a_point_to_end_at(self):
        """A mesh that takes seconds to make, and a job that never comes."""
        os.mkfifo(self.folder / "never.json")
        for arguments, delay_s in ((["make", "tee", "--edge", "0.4", "-o", "a.stl"], 1),
                                   (["tee.stl", "--job", "never.json", "-o", "out"], 1)):
            with self.subTest(arguments[0]):
                process = subprocess.Popen([program.PROGRAM, *arguments, "--quiet"],
                                           cwd=self.folder, stdin=subprocess.DEVNULL,
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                           text=True, preexec_fn=listen_to_signals)
                self.addCleanup(process.kill)
                time.sleep(delay_s)
                lines = self.ended(process, signal.SIGTERM)
                self.assertEqual(lines, ["meshwind: interrupted; nothing unfinished is left"])
                self.assertEqual([p.name for p in self.folder.iterdir()], ["never.json"])

    def test_ignored_signal_stays_ignored(self):
        process = subprocess.Popen([program.PROGRAM, "make", "cylinder", "--edge", "0.5", "-o",
                                    "a.stl"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT,
                                                                    signal.SIG_IGN))
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=program.TIMEOUT_S)
        self.assertEqual(process.returncode, 0)
        self.assertTrue((self.folder / "a.stl").exists())


class Bar(program.ProgramTest):
    def test_bar_on_a_terminal_is_wiped_and_stdout_is_clean(self):
        mandrel = self.make("cylinder", "--radius", "40", "--length", "160", "--edge", "10")
        job = self.write("hoops.json", '{"tow": {"width": 12}, "layers": [{"kind": "hoop"}]}')
        terminal, program_side = pty.openpty()
        fcntl.ioctl(program_side, termios.TIOCSWINSZ, struct.pack("HHHH", 24, COLUMNS, 0, 0))
        begun = time.monotonic()
        with open(self.folder / "stdout.txt", "wb") as stdout:
            process = subprocess.Popen([program.PROGRAM, mandrel, "--job", job, "--force"],
                                       cwd=self.folder, stdin=subprocess.DEVNULL, stdout=stdout,
                                       stderr=program_side)
        os.close(program_side)
        text = b""
        while True:
            try:
                part = os.read(terminal, 4096)
            except OSError:  # Linux: the other side is closed
                break
            if not part:
                break
            text += part
        process.wait(timeout=program.TIMEOUT_S)
        seconds = time.monotonic() - begun
        os.close(terminal)
        drawn = text.decode().split("meshwind: ")[0]
        self.assertTrue(drawn.startswith(WIPE + "1 of 8: reading the part ["), drawn[:80])
        self.assertTrue(drawn.endswith(WIPE), drawn[-80:])
        bars = drawn.split(WIPE)[1:-1]
        self.assertGreaterEqual(len(bars), 2)
        self.assertLessEqual(len(bars), 10 * seconds + 1)
        for bar in bars:
            self.assertLess(len(bar), COLUMNS)
            self.assertIn("[", bar)
            self.assertNotIn("\n", bar)
        out = (self.folder / "stdout.txt").read_text()
        self.assertIn("report:", out)
        self.assertFalse({"\r", "\033", "#"} & set(out))

    def test_quiet_says_nothing(self):
        mandrel = self.make("cylinder", "--radius", "40", "--length", "60", "--edge", "15")
        job = self.write("hoops.json",
                         '{"tow": {"width": 12}, "mandrel": {"extension": 0}, "layers": [{"kind": "hoop"}]}')
        result = self.run_program(mandrel, "--job", job, "--quiet")
        self.assertEqual(result.stdout, "")
        self.assertFalse([line for line in result.stderr.splitlines()
                          if not line.startswith("meshwind: ")])


if __name__ == "__main__":
    program.main("__main__")
