"""The commands of the workbench: a dialog that winds the chosen part, and one that shows a run made before."""
import tempfile
from pathlib import Path

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

import meshwind_freecad as winding


class WindPanel:
    """Task panel: machine, job, tow; meshwind runs beside FreeCAD, and what it makes is shown when it is done."""

    def __init__(self, part):
        self.part = part
        self.process = None
        self.folder = Path(tempfile.mkdtemp(prefix="meshwind-"))
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(f"Wind {part.Label}")
        layout = QtGui.QFormLayout(self.form)
        self.machine = self.add_file(layout, "Machine", "six_axis.json")
        self.job = self.add_file(layout, "Job", "")
        self.width = self.add_number(layout, "Tow width", " mm", 6.0, 0.1, 200.0)
        self.thickness = self.add_number(layout, "Tow thickness", " mm", 0.25, 0.01, 10.0)
        self.friction = self.add_number(layout, "Friction", "", 0.2, 0.0, 2.0)
        self.effort = self.add_number(layout, "Effort", "", 1.0, 0.01, 100.0)
        self.out = QtGui.QLineEdit(str(self.folder / "run"))
        layout.addRow("Output folder", self.out)
        self.said = QtGui.QPlainTextEdit()
        self.said.setReadOnly(True)
        layout.addRow(self.said)
        # A job file says all of it.
        self.job.textChanged.connect(self.follow_job)

    def add_file(self, layout, label, text):
        line = QtGui.QLineEdit(text)
        row = QtGui.QHBoxLayout()
        button = QtGui.QPushButton("...")
        button.setMaximumWidth(30)
        row.addWidget(line)
        row.addWidget(button)
        button.clicked.connect(lambda: self.choose(line, label))
        layout.addRow(label, row)
        return line

    def choose(self, line, label):
        file = QtGui.QFileDialog.getOpenFileName(self.form, label, "", "JSON (*.json)")[0]
        if file:
            line.setText(file)

    def add_number(self, layout, label, unit, value, least, most):
        box = QtGui.QDoubleSpinBox()
        box.setDecimals(2)
        box.setRange(least, most)
        box.setSuffix(unit)
        box.setValue(value)
        layout.addRow(label, box)
        return box

    def follow_job(self, job):
        for box in (self.width, self.thickness, self.friction):
            box.setEnabled(not job)

    def settings(self):
        if self.job.text():
            return {}
        return {"tow.width": self.width.value(), "tow.thickness": self.thickness.value(),
                "tow.friction": self.friction.value()}

    def getStandardButtons(self):
        return int(QtGui.QDialogButtonBox.Ok | QtGui.QDialogButtonBox.Cancel)

    def accept(self):
        """Begins a run; the panel stays until it ends."""
        if self.process is not None:
            return False
        try:
            file = winding.write_part(self.part, self.folder)
            program = winding.find_program()
        except winding.WindingError as error:
            self.said.appendPlainText(str(error))
            return False
        self.process = QtCore.QProcess()
        variables = QtCore.QProcessEnvironment()
        for name, value in winding.environment().items():
            variables.insert(name, value)
        self.process.setProcessEnvironment(variables)
        self.process.readyReadStandardError.connect(self.progress)
        self.process.finished.connect(self.ended)
        self.errors = ""
        self.process.start(program, winding.arguments(
            file, self.out.text(), machine=self.machine.text(), job=self.job.text(), settings=self.settings(),
            effort=self.effort.value()))
        self.said.appendPlainText("winding ...")
        return False

    def progress(self):
        text = bytes(self.process.readAllStandardError()).decode(errors="replace")
        self.errors += text
        self.said.appendPlainText(text.strip())

    def ended(self, code, _status=None):
        output = bytes(self.process.readAllStandardOutput()).decode(errors="replace")
        self.process = None
        try:
            end = winding.end_of_run(code, output, self.errors, self.out.text())
        except winding.WindingError as error:
            self.said.appendPlainText(str(error))
            return
        self.said.appendPlainText(end.text)
        winding.show_run(self.part.Document, end.folder)
        FreeCADGui.SendMsgToActiveView("ViewFit")

    def reject(self):
        if self.process is not None:
            self.process.finished.disconnect(self.ended)
            self.process.terminate()
            self.process.waitForFinished(5000)
        FreeCADGui.Control.closeDialog()


class WindCommand:
    """Opens the panel for the chosen part."""

    def GetResources(self):
        return {"MenuText": "Wind the chosen part", "ToolTip": "Plan fibre for it, and the program of a machine"}

    def IsActive(self):
        return len(FreeCADGui.Selection.getSelection()) == 1

    def Activated(self):
        FreeCADGui.Control.showDialog(WindPanel(FreeCADGui.Selection.getSelection()[0]))


class ShowCommand:
    """Shows a run that was made before."""

    def GetResources(self):
        return {"MenuText": "Show a run", "ToolTip": "Fibre, wall and report of an output folder of meshwind"}

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None

    def Activated(self):
        folder = QtGui.QFileDialog.getExistingDirectory(None, "Output folder of meshwind")
        if folder:
            winding.show_run(FreeCAD.ActiveDocument, folder)
            FreeCADGui.SendMsgToActiveView("ViewFit")


def add_commands():
    """Names of the commands, for menu and toolbar."""
    FreeCADGui.addCommand("Meshwind_Wind", WindCommand())
    FreeCADGui.addCommand("Meshwind_Show", ShowCommand())
    return ["Meshwind_Wind", "Meshwind_Show"]
