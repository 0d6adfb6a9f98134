"""Tables of cases: a row at a time, all of them by GNU parallel (data/batch/parallel.sh), and what comes of them."""
import csv
import json
import os
import subprocess

import program


class CasesTest(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.make("cylinder", "--radius", 30, "--length", 120, "--edge", 8)
        self.table = self.write("cases.csv", "id,mandrel,tow.width,layers.0.angle,layers.0.kind\n"
                                             "wide,cylinder.stl,12,50,helical\n"
                                             "narrow,cylinder.stl,8,55,helical\n"
                                             "lost,other.stl,12,,\n"
                                             "wrong,cylinder.stl,12,50,helix\n")

    def case(self, row):
        return self.run_program("--quiet", "study", "cases", self.table, "--row", row, "-o", "out")

    def merged(self, *options):
        result = self.run_program("study", "merge", self.table, "-o", "out", *options)
        with (self.folder / "out/cases.csv").open(newline="") as rows:
            return result, {row["id"]: row for row in csv.DictReader(rows)}

    def end(self, name):
        return json.loads((self.folder / f"out/{name}.json").read_text())

    def test_rows_end_as_the_main_job_does(self):
        self.assertEqual([self.case(row).returncode for row in (1, 3, 4)], [0, 2, 2])
        self.assertEqual([self.end(name)["exit_code"] for name in ("wide", "lost", "wrong")], [0, 2, 2])
        self.assertEqual(self.end("lost")["error"]["code"], "mesh.missing_file")
        self.assertTrue((self.folder / "out/wide/program.ngc").exists())
        result, rows = self.merged()
        self.assertEqual(result.returncode, 1)
        self.assertEqual([row["outcome"] for row in rows.values()], ["ok", "missing", "error", "error"])
        report = json.loads((self.folder / "out/wide/report.json").read_text())
        self.assertEqual(float(rows["wide"]["duration_s"]), report["program"]["duration_s"])
        self.assertEqual(self.merged("--json")[0].stdout and json.loads(self.merged("--json")[0].stdout)["missing"], [2])
        self.assertEqual(self.merged("--left")[0].stdout, "2,3,4\n")
        self.assertEqual(self.case(5).returncode, 2)
        self.assertEqual(self.case(0).returncode, 2)

    def test_a_row_that_is_stopped_is_missing(self):
        self.case(1)
        table = self.table.read_text().replace("wide,cylinder.stl,12", "wide,tee.stl,12")
        self.table.write_text(table)
        process = subprocess.Popen([program.PROGRAM, "study", "cases", self.table, "--row", "1", "-o", "out"],
                                   cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        process.stderr.read(1)  # it has begun
        self.ended_by(process, 15)
        self.assertEqual(self.merged()[1]["wide"]["outcome"], "missing")

    def test_parallel_runs_only_what_is_left(self):
        batch = [program.SOURCE / "data/batch/parallel.sh", self.table, "out"]
        environment = {**os.environ, "MESHWIND": program.PROGRAM}
        first = subprocess.run(batch, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=900)
        self.assertEqual(first.returncode, 1, first.stderr)
        self.assertIn("4 cases: 2 ok, 2 failed, 0 missing", first.stdout)
        self.assertIn("failed  rows 3,4", first.stdout)
        done = {name: (self.folder / f"out/{name}.json").stat().st_mtime_ns for name in ("wide", "narrow")}
        (self.folder / "other.stl").write_bytes((self.folder / "cylinder.stl").read_bytes())
        self.table.write_text(self.table.read_text().replace("helix", "helical"))
        second = subprocess.run(batch, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=900)
        self.assertEqual(second.returncode, 0, second.stdout + second.stderr)
        for name, time in done.items():
            self.assertEqual((self.folder / f"out/{name}.json").stat().st_mtime_ns, time)
        log = (self.folder / "out.log.tsv").read_text().splitlines()
        self.assertEqual(len(log) - 1, 2)  # rows of the second call


if __name__ == "__main__":
    program.main(__name__)
