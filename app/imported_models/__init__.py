"""Models that a team imports: FreeCAD files, models in Creo, and STEP files as fixed parts."""
