"""FreeCAD as a program that draws: the process in which it opens one file, and which files it may open."""
