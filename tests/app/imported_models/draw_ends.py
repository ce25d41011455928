"""Draws documents of FreeCAD whose ends are empty, renamed or doubled: run by the Python of FreeCAD.

Arguments: the folder of FreeCAD's modules, the folder to save to, and a JSON list of [name, kind, sizes].
"""

import json
import sys
from pathlib import Path

sys.path.insert(0, sys.argv[1])
import FreeCAD  # before all that belong to it
import Part
import Spreadsheet  # noqa: F401


class Document:
    """A document with a spreadsheet of the sizes of one kind of model."""

    def __init__(self, name, sizes):
        self.document = FreeCAD.newDocument(name)
        self.sheet = self.document.addObject("Spreadsheet::Sheet", "Sizes")
        for row, (alias, text) in enumerate(sizes.items(), 1):
            self.sheet.set(f"B{row}", str(text))
            self.sheet.setAlias(f"B{row}", alias)
        self.document.recompute()

    def box(self, name, length, x="0 mm", width="40 mm", height="40 mm"):
        box = self.document.addObject("Part::Box", name)
        for key, value in (("Length", length), ("Width", width), ("Height", height), ("Placement.Base.x", x)):
            self.set(box, key, value)
        return box

    def set(self, thing, key, value):
        """Set a property to a length, or bind it to an expression."""
        if value[0].isalpha():
            thing.setExpression(key, value)
        elif key == "Placement.Base.x":
            thing.Placement.Base.x = FreeCAD.Units.Quantity(value)
        else:
            setattr(thing, key, value)

    def rod(self, name, radius, x="20 mm", height="100 mm"):
        rod = self.document.addObject("Part::Cylinder", name)
        rod.Placement.Base = FreeCAD.Vector(20, 20, -10)
        for key, value in (("Radius", radius), ("Height", height), ("Placement.Base.x", x)):
            self.set(rod, key, value)
        return rod

    def made(self, kind, name, first, second):
        made = self.document.addObject(f"Part::{kind}", name)
        made.Base, made.Tool = first, second
        for one in (first, second):
            one.Visibility = False
        return made


def cut(d):  # the last feature comes out empty at a large hole
    d.made("Cut", "Bored", d.box("Block", "40 mm"), d.rod("Drill", "Sizes.hole"))


def common(d):  # the last feature comes out empty if the rod is moved away
    d.made("Common", "Core", d.box("Block", "40 mm"), d.rod("Rod", "5 mm", "Sizes.at"))


def inner(d):  # a feature in the middle comes out empty at a large hole
    lump = d.box("Lump", "30 mm", "-20 mm", "30 mm")
    boss = d.made("Cut", "Boss", lump, d.rod("Drill", "Sizes.hole", "-5 mm"))
    d.made("Fuse", "Whole", d.box("Block", "40 mm"), boss)


def split(d):  # a wide slot cuts the part into two
    block = d.box("Block", "40 mm")
    d.made("Cut", "Slotted", block, d.box("Slot", "10 mm", "15 mm", "Sizes.depth", "60 mm"))


def met(d):  # two parts, of which one is moved into the other
    d.box("Left", "40 mm")
    d.box("Right", "40 mm", "Sizes.at")


def doubled(d):  # two parts in the same place
    d.box("One", "Sizes.length")
    d.box("Other", "Sizes.length")


def alike(d):  # two parts with one label, which has quotation marks
    for x in ("0 mm", "100 mm"):
        d.box("Rail", "Sizes.length", x).Label = 'Rail "A"'


def tied(d):  # the size of one part follows from that of another
    d.box("First", "Sizes.length")
    d.box("Second", "First.Length", "100 mm")


def linked(d):  # a link doubles a part
    link = d.document.addObject("App::Link", "Again")
    link.LinkedObject = d.box("Block", "Sizes.length")
    link.Placement.Base = FreeCAD.Vector(100, 0, 0)


def hidden(d):  # a part that the file does not show
    d.box("Shown", "Sizes.length")
    d.box("Unseen", "Sizes.length", "100 mm").Visibility = False


def unitless(d):  # numbers without units, of which one drives a radius and one nothing
    d.made("Cut", "Bored", d.rod("Ring", "Sizes.outside * 1 mm"), d.rod("Drill", "Sizes.d1 * 1 mm"))
    d.document.Ring.setExpression("Height", "floor(Sizes.count) * 10 mm")


def ring(d):  # its hole can grow beyond its outer face
    d.made(
        "Cut", "Bored", d.rod("Outside", "max(Sizes.bore; 30 mm)"), d.rod("Inside", "min(Sizes.bore; 30 mm)")
    )


def reversed_part(d):  # a part whose faces point inwards
    shape = Part.makeBox(10, 10, 10)
    shape.reverse()
    d.document.addObject("Part::Feature", "Reversed").Shape = shape


def loose(d):  # a part with a face beside its solid, a face alone, and two parts that overlap
    face = Part.makePlane(5, 5, FreeCAD.Vector(0, 0, 50))
    d.document.addObject("Part::Feature", "Mixed").Shape = Part.makeCompound([Part.makeBox(10, 10, 10), face])
    d.document.addObject("Part::Feature", "Sheet").Shape = face
    d.box("Beside", "20 mm", "5 mm", "10 mm", "10 mm")
    d.document.recompute()


for name, kind, sizes in json.loads(sys.argv[3]):
    drawn = Document(name, sizes)
    globals()[kind](drawn)
    drawn.document.recompute()
    drawn.document.saveAs(str(Path(sys.argv[2], f"{name}.FCStd")))
    FreeCAD.closeDocument(drawn.document.Name)
