"""A model with two versions, the first of them withdrawn, as files of a team's folder: `plate`."""

from pathlib import Path
from textwrap import dedent

PLATE = '''
"""A square plate."""

from cadquery import Solid, Vector

from cad.model import Box, CadModel, Part, mm
from templates.core.language.template import Array, formula, given


class Plate(CadModel):
    """A square plate, a tenth as thick as it is wide."""

    withdrawn = "too thin, use 2"
    example = {"size": "10 mm"}

    a: Array = given("mm", "size", gt=0, le=1000)

    @formula("mm", "thickness", symbol="t")
    def t(self) -> Array:
        return self.a / 10

    def build(self):
        size, thickness = mm(self.a), mm(self.t)
        return (Part("plate", Solid.makeBox(size, size, thickness), size * size * thickness),)

    def bounding_box(self):
        return Box((0, 0, 0), (mm(self.a), mm(self.a), mm(self.t)))

    def dimensions(self, seen):
        return {"size": seen["plate"].length(Vector(1, 0, 0))}
'''
"""Version 1."""

THICKER = (
    PLATE.replace("a tenth as thick", "a fifth as thick")
    .replace("self.a / 10", "self.a / 5")
    .replace('    withdrawn = "too thin, use 2"\n', "")
)
"""Version 2: twice as thick."""


def folder_of_two_versions(path: Path) -> Path:
    """Write both versions into a folder of their own; return the folder."""
    path.mkdir(parents=True)
    for number, text in enumerate((PLATE, THICKER), 1):
        (path / f"plate_v{number}.py").write_text(dedent(text).lstrip())
    return path
