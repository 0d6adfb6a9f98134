#!/usr/bin/env python3
"""How long LinuxCNC itself takes for a program, on the limits of a machine file.

    linuxcnc_time.py MACHINE.json PROGRAM.ngc

Runs the program once through LinuxCNC's own task and trajectory planner, in its simulator, without hardware, display or
real time, and counts the cycles of the servo thread from the first feed move to the last motion: seconds of the controller,
whatever else this computer does. It takes as long as the program. Needs `apt-get install --no-install-recommends
linuxcnc-uspace`, and a user who is not root. Stops (M0) are taken out.

Prints the seconds. Exit codes: 0 done, 1 LinuxCNC does not run it, 2 usage, 77 LinuxCNC is not here.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PERIOD_S = 1e-3
SAMPLES_KEPT = 20000
ANY = 1e8  # a limit that is none

RUN = """#!/usr/bin/python3
import sys, time
import linuxcnc
command, state, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
time.sleep(1.0)
for wanted in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON):
    command.state(wanted)
    command.wait_complete()
command.home(-1)
time.sleep(1.0)
command.mode(linuxcnc.MODE_AUTO)
command.wait_complete()
command.program_open({program!r})
command.wait_complete()
command.auto(linuxcnc.AUTO_RUN, 0)
time.sleep(1.0)
while True:
    state.poll()
    error = errors.poll()
    if error and error[0] in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR):
        open({failed!r}, "w").write(error[1])
        break
    if state.interp_state == linuxcnc.INTERP_IDLE and state.inpos and state.queue == 0:
        break
    time.sleep(0.05)
time.sleep(0.5)
"""


def section(name, **values):
    return f"[{name}]\n" + "".join(f"{key} = {value}\n" for key, value in values.items())


def configuration(axes, folder):
    """The texts of INI and HAL files for axes in LinuxCNC's order."""
    letters = "".join(axis["letter"] for axis in axes)
    ini = section("EMC", VERSION="1.1", MACHINE="clock", DEBUG=0)
    ini += section("DISPLAY", DISPLAY=folder / "run.py")
    ini += section("TASK", TASK="milltask", CYCLE_TIME=0.001)
    ini += section("RS274NGC", PARAMETER_FILE=folder / "parameters")
    ini += section("EMCMOT", EMCMOT="motmod", COMM_TIMEOUT=4.0, SERVO_PERIOD=round(1e9 * PERIOD_S))
    ini += section("EMCIO", EMCIO="io", CYCLE_TIME=0.1, TOOL_TABLE=folder / "tools")
    ini += section("HAL", HALFILE=folder / "clock.hal")
    ini += section("KINS", KINEMATICS=f"trivkins coordinates={letters}", JOINTS=len(axes))
    ini += section("TRAJ", COORDINATES=" ".join(letters), LINEAR_UNITS="mm", ANGULAR_UNITS="degree", DEFAULT_LINEAR_VELOCITY=100,
                   MAX_LINEAR_VELOCITY=ANY, MAX_ANGULAR_VELOCITY=ANY, DEFAULT_LINEAR_ACCELERATION=ANY,
                   MAX_LINEAR_ACCELERATION=ANY, NO_FORCE_HOMING=1)
    hal = ("loadrt [KINS]KINEMATICS\n"
           "loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS\n"
           f"loadrt sampler depth={SAMPLES_KEPT} cfg={'f' * len(axes)}s\n"
           "addf motion-command-handler servo-thread\naddf motion-controller servo-thread\n"
           "addf sampler.0 servo-thread\nsetp sampler.0.enable 1\n")
    for i, axis in enumerate(axes):
        limits = dict(MIN_LIMIT=-ANY, MAX_LIMIT=ANY, MAX_VELOCITY=axis["velocity"], MAX_ACCELERATION=axis["acceleration"])
        kind = "LINEAR" if axis["type"] == "linear" else "ANGULAR"
        ini += section(f"AXIS_{axis['letter']}", **limits)
        ini += section(f"JOINT_{i}", TYPE=kind, HOME=0, HOME_SEQUENCE=0, FERROR=ANY, MIN_FERROR=ANY, **limits)
        hal += f"net joint{i} joint.{i}.motor-pos-cmd => joint.{i}.motor-pos-fb sampler.0.pin.{i}\n"
    hal += (f"net line motion.program-line => sampler.0.pin.{len(axes)}\n"
            "net enable iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n"
            f"loadusr halsampler {folder / 'samples'}\n")
    return ini, hal


def seconds(samples, first_line):
    """From the first cycle in a line to the last that moves."""
    rows = [line.split() for line in samples.read_text().splitlines()]
    begin = next(i for i, row in enumerate(rows) if int(row[-1]) == first_line)
    end = max(i for i in range(1, len(rows)) if rows[i][:-1] != rows[i - 1][:-1])
    return (end - begin + 1) * PERIOD_S


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    if not shutil.which("linuxcnc") or os.geteuid() == 0:
        print("linuxcnc_time: LinuxCNC is not installed, or this is root", file=sys.stderr)
        return 77
    machine = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    axes = sorted(machine["mandrel_chain"] + machine["eye_chain"], key=lambda axis: "XYZABCUVW".index(axis["letter"]))
    text = re.sub(r"^M0\b.*$", "", pathlib.Path(sys.argv[2]).read_text(encoding="utf-8"), flags=re.M)
    first_line = next(i for i, line in enumerate(text.splitlines(), 1) if line.startswith("G1"))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "program.ngc").write_text(text, encoding="utf-8")
        (folder / "tools").touch()
        ini, hal = configuration(axes, folder)
        (folder / "clock.ini").write_text(ini, encoding="utf-8")
        (folder / "clock.hal").write_text(hal, encoding="utf-8")
        failed = folder / "failed"
        (folder / "run.py").write_text(RUN.format(program=str(folder / "program.ngc"), failed=str(failed)), encoding="utf-8")
        (folder / "run.py").chmod(0o755)
        # It writes to a terminal, so it gets one.
        command = ["script", "--quiet", "--command", f"linuxcnc {folder / 'clock.ini'}", str(folder / "said")]
        subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, check=False)
        if failed.exists() or not (folder / "samples").exists():
            print("linuxcnc_time:", failed.read_text() if failed.exists() else (folder / "said").read_text()[-500:], file=sys.stderr)
            return 1
        print(f"{seconds(folder / 'samples', first_line):.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
