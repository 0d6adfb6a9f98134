# The workbench in FreeCAD's list.
import FreeCADGui


class MeshwindWorkbench(FreeCADGui.Workbench):
    """Winds the part that is chosen."""

    MenuText = "Filament winding"
    ToolTip = "Fibre wound on a part by meshwind: plan, program, wall"

    def Initialize(self):
        import meshwind_commands

        commands = meshwind_commands.add_commands()
        self.appendToolbar("Filament winding", commands)
        self.appendMenu("Filament winding", commands)

    def GetClassName(self):
        return "Gui::PythonWorkbench"


FreeCADGui.addWorkbench(MeshwindWorkbench())
