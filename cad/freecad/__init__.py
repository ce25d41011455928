"""FreeCAD as a drawing program: the process in which it opens one file, and the files that it may open."""
