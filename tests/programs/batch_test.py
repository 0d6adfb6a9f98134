"""Forty cases, two of which fail, by GNU parallel and as an array of jobs of Slurm (data/batch): a second call runs these alone.

For Slurm a cluster of this one computer is made, as root: munge, slurmctld, slurmd."""
import csv
import os
import shutil
import subprocess
import time

import program

CASES = 40
CONFIGURATION = """ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus}
PartitionName=all Nodes=ALL Default=YES
"""


class FortyCases:
    def left(self):
        return self.done("study", "merge", "cases.csv", "-o", "out", "--left").stdout.strip()

    def ends(self):
        return {file.stem: file.stat().st_mtime_ns for file in (self.folder / "out").glob("*.json")}

    def test_forty_cases(self):
        self.make("cylinder", "--radius", 30, "--length", 120, "--edge", 8)
        mandrels = ["cylinder.stl"] * CASES
        mandrels[11] = mandrels[29] = "lost.stl"
        self.write("cases.csv", "id,mandrel,tow.thickness,tow.width,layers.0.angle,layers.0.kind\n" + "".join(
            f"case-{k},{mandrel},{0.2 + 0.002 * k:.3f},12,50,helical\n" for k, mandrel in enumerate(mandrels, 1)))
        self.assertEqual(self.left(), ",".join(map(str, range(1, CASES + 1))))
        self.run_cases()
        merged = self.run_program("study", "merge", "cases.csv", "-o", "out")
        self.assertIn(f"{CASES} cases: {CASES - 2} ok, 2 failed, 0 missing", merged.stdout)
        before = self.ends()
        shutil.copy(self.folder / "cylinder.stl", self.folder / "lost.stl")
        self.assertEqual(self.left(), "12,30")
        self.run_cases()
        self.done("study", "merge", "cases.csv", "-o", "out")
        after = self.ends()
        self.assertEqual({name for name in after if after[name] != before.get(name)}, {"case-12", "case-30"})
        with (self.folder / "out/cases.csv").open(newline="") as rows:
            self.assertEqual({row["outcome"] for row in csv.DictReader(rows)}, {"ok"})


class Parallel(FortyCases, program.ProgramTest):
    def run_cases(self):
        subprocess.run([program.SOURCE / "data/batch/parallel.sh", "cases.csv", "out"], cwd=self.folder,
                       env={**os.environ, "MESHWIND": program.PROGRAM}, capture_output=True, check=False)


class Slurm(FortyCases, program.ProgramTest):
    def setUp(self):
        super().setUp()
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        host = os.uname().nodename.split(".")[0]
        file = self.write("slurm.conf", CONFIGURATION.format(host=host, folder=self.folder, cpus=os.cpu_count()))
        self.environment = {**os.environ, "SLURM_CONF": str(file), "MESHWIND": program.PROGRAM}
        subprocess.run(["install", "-d", "-o", "munge", "-g", "munge", "/run/munge"], check=True)
        subprocess.run(["runuser", "-u", "munge", "--", "/usr/sbin/munged", "--force"], check=True)
        self.addCleanup(subprocess.run, ["pkill", "munged"], check=False)
        for daemon in ("slurmctld", "slurmd"):
            process = subprocess.Popen([shutil.which(daemon, path="/usr/sbin"), "-D"], env=self.environment,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.addCleanup(process.wait)
            self.addCleanup(process.terminate)
        deadline = time.monotonic() + 60
        while "idle" not in self.slurm("sinfo", "-h", "-o", "%t"):
            self.assertLess(time.monotonic(), deadline, (self.folder / "slurmctld.log").read_text())
            time.sleep(0.5)

    def slurm(self, *words):
        return subprocess.run(words, cwd=self.folder, env=self.environment, capture_output=True, text=True,
                              check=False).stdout.strip()

    def run_cases(self):
        self.slurm("sbatch", "--wait", f"--array={self.left()}", str(program.SOURCE / "data/batch/slurm.sh"), "cases.csv", "out")


if __name__ == "__main__":
    program.main(__name__)
