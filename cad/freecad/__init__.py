"""FreeCAD as an external CAD program: the process in which it opens one file, and the check of that file."""
