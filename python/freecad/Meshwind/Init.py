# FreeCAD reads this file of every workbench at its start; ours has nothing to do without a window.
