"""Models that a team brings: files of FreeCAD, sessions of Creo, STEP files as fixed parts."""
