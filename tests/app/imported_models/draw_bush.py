"""Draws a bush by FreeCAD, and saves it: run by the Python for which FreeCAD is installed.

Arguments: the folder of FreeCAD's modules, the file, and what to add to it.
"""

import math
import sys
from pathlib import Path

sys.path.insert(0, sys.argv[1])
import FreeCAD  # before all that belong to it
import Part
import Sketcher

import _PartDesign  # isort: skip

sys.modules["PartDesign"] = _PartDesign
PLACE, WHAT = sys.argv[2], sys.argv[3]
document = FreeCAD.newDocument("bush")
document.Label = "Main bush"

sheet = document.addObject("Spreadsheet::Sheet", "Sizes")
for cell, alias, text in (
    ("B1", "bore", "50 mm"),
    ("B2", "width", "25 mm"),
    ("B3", "wall", "=bore / 10"),  # a formula: no parameter
    ("B4", "words", "steel"),
    ("B5", "mass", "3 kg"),  # of no unit that is offered
    ("B7", "moment", "2 kg*mm"),  # nor this one, which has no name
):
    sheet.set(cell, text)
    sheet.setAlias(cell, alias)
document.recompute()

body = document.addObject("PartDesign::Body", "Bush")
sketch = body.newObject("Sketcher::SketchObject", "Ring")
for radius in (25, 30):
    sketch.addGeometry(Part.Circle(FreeCAD.Vector(0, 0, 0), FreeCAD.Vector(0, 0, 1), radius), False)
    number = len(sketch.Geometry) - 1
    sketch.addConstraint(Sketcher.Constraint("Coincident", number, 3, -1, 1))
bore = sketch.addConstraint(Sketcher.Constraint("Diameter", 0, 50.0))
sketch.renameConstraint(bore, "inner")
outside = sketch.addConstraint(Sketcher.Constraint("Diameter", 1, 60.0))
sketch.renameConstraint(outside, "outerDiameter")
sketch.setExpression("Constraints.inner", "Sizes.bore")
pad = body.newObject("PartDesign::Pad", "Width")
pad.Profile = sketch
pad.setExpression("Length", "Sizes.width")

if WHAT == "python feature":

    class Proxy:
        def execute(self, thing):
            open("/tmp/freecad-was-run", "w").close()

    thing = document.addObject("Part::FeaturePython", "Script")
    thing.Proxy = Proxy()
if WHAT == "endless":
    # Boolean fusions of a lattice of spheres that all cross each other: minutes, not seconds.
    spheres = [document.addObject("Part::Torus", f"T{n}") for n in range(60)]
    for n, one in enumerate(spheres):
        one.Radius1, one.Radius2 = 40 + n % 7, 9 + n % 3
        one.Placement = FreeCAD.Placement(
            FreeCAD.Vector(3 * math.sin(n), 3 * math.cos(2 * n), n / 3),
            FreeCAD.Rotation(FreeCAD.Vector(math.sin(n), 1, math.cos(n)), 17 * n),
        )
    fused = document.addObject("Part::MultiFuse", "Fused")
    fused.Shapes = spheres
if WHAT == "memory":
    grown = body.newObject("PartDesign::LinearPattern", "Many")
    grown.Originals = [pad]
    grown.Direction = (sketch, ["N_Axis"])
    grown.Length, grown.Occurrences = 1e5, 2
    sheet.set("B6", "2")
    sheet.setAlias("B6", "copies")
    grown.setExpression("Occurrences", "Sizes.copies")
if WHAT not in ("endless",):
    document.recompute()
document.saveAs(PLACE)
Path("/tmp/freecad-was-run").unlink(missing_ok=True)  # by the drawing of this script
