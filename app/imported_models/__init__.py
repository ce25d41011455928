"""Models that a team imports: FreeCAD files, Creo sessions, and STEP files as fixed parts."""
