"""A second reader of STEP files: entities as nested lists, and their PMI; it shares no code with `cad`.

It follows each dimension from its limits down to the surfaces of its faces, so a test can compare what the
file says with the geometry that says it.
"""

import re
from collections import defaultdict
from dataclasses import dataclass

TOKEN = re.compile(r"\s+|(?P<text>'(?:[^']|'')*')|(?P<mark>[(),])|(?P<word>[^\s'(),]+)")
NUMBER = re.compile(r"[-+]?\d+\.\d*(E[-+]?\d+)?")


class Word(str):
    """A keyword, an enumeration, `$` or `*`."""


@dataclass(frozen=True)
class Ref:
    """A reference to an entity."""

    number: int


@dataclass(frozen=True)
class Dimension:
    """A toleranced dimension, and the surfaces on each of its sides by keyword and radius.

    `places` are these surfaces with a point and a direction: of a plane its normal, else the axis.
    """

    name: str
    kind: str
    nominal: float
    lower: float
    upper: float
    sides: tuple[frozenset[tuple[str, float]], ...]
    places: tuple[tuple[tuple, ...], ...] = ()


def parsed(body):
    """The list of everything between brackets; a keyword stands before the list of its arguments."""
    stack = [[]]
    for match in TOKEN.finditer(body):
        if match["text"]:
            stack[-1].append(match["text"][1:-1].replace("''", "'"))
        elif match["mark"] == "(":
            stack.append([])
        elif match["mark"] == ")":
            closed = stack.pop()
            stack[-1].append(closed)
        elif word := match["word"]:
            is_ref = re.fullmatch(r"#\d+", word)
            number = float(word) if NUMBER.fullmatch(word) else Word(word)
            stack[-1].append(Ref(int(word[1:])) if is_ref else number)
    assert len(stack) == 1
    return stack[0]


class File:
    """The entities of a STEP file."""

    def __init__(self, step):
        data = step.decode("latin-1").split("DATA;", 1)[1].rsplit("ENDSEC;", 1)[0]
        lines = re.findall(r"#(\d+) = ((?:[^';]|'(?:[^']|'')*')*);", data)
        self.entities = {int(number): self._parts(parsed(body)) for number, body in lines}
        assert len(self.entities) == len(lines), "two entities have one number"
        self.of = defaultdict(list)
        for number, parts in self.entities.items():
            for keyword in parts:
                self.of[keyword].append(number)

    @staticmethod
    def _parts(items):
        """Keywords with their arguments: one of a simple entity, several of a complex one."""
        items = items[0] if isinstance(items[0], list) else items
        return {str(items[i]): items[i + 1] for i in range(0, len(items), 2)}

    def get(self, ref, keyword):
        return self.entities[ref.number][keyword]

    def dangling(self):
        """References to entities that are not there."""
        waiting = [arguments for parts in self.entities.values() for arguments in parts.values()]
        while waiting:
            one = waiting.pop()
            if isinstance(one, list):
                waiting += one
            elif isinstance(one, Ref) and one.number not in self.entities:
                yield one

    def measure(self, ref):
        """The magnitude of a measure with its type's name."""
        kind, (value,) = self.get(ref, "MEASURE_WITH_UNIT")[:2]
        assert kind in ("LENGTH_MEASURE", "POSITIVE_LENGTH_MEASURE")
        return value

    def dimensions(self):
        """Every toleranced dimension."""
        shown = {}
        for number in self.of["DIMENSIONAL_CHARACTERISTIC_REPRESENTATION"]:
            dimension, representation = self.entities[number]["DIMENSIONAL_CHARACTERISTIC_REPRESENTATION"]
            shown[dimension] = self.get(representation, "SHAPE_DIMENSION_REPRESENTATION")
        for number in self.of["PLUS_MINUS_TOLERANCE"]:
            limits, dimension = self.entities[number]["PLUS_MINUS_TOLERANCE"]
            lower, upper = map(self.measure, self.get(limits, "TOLERANCE_VALUE"))
            name, (item,), _ = shown[dimension]
            ((keyword, arguments),) = self.entities[dimension.number].items()
            kind = next(a for a in arguments if type(a) is str)
            aspects = [a for a in arguments if isinstance(a, Ref)]
            faces = [self.faces(aspect) for aspect in aspects]
            sides = tuple(frozenset(map(self.surface, some)) for some in faces)
            places = tuple(tuple(map(self.place, some)) for some in faces)
            assert len(sides) == (1 if keyword == "DIMENSIONAL_SIZE" else 2)
            yield Dimension(name, kind, self.measure(item), lower, upper, sides, places)

    def faces(self, aspect):
        """The faces and edges of a shape aspect, or of the aspects of which it is composed."""
        members = {aspect}
        for number in self.of["SHAPE_ASPECT_RELATIONSHIP"]:
            one, other = self.entities[number]["SHAPE_ASPECT_RELATIONSHIP"][2:]
            members |= {other} if one == aspect else set()
        faces = [
            arguments[4]
            for number in self.of["GEOMETRIC_ITEM_SPECIFIC_USAGE"]
            if (arguments := self.entities[number]["GEOMETRIC_ITEM_SPECIFIC_USAGE"])[2] in members
        ]
        assert faces, "an aspect of no face"
        return faces

    def geometry(self, item):
        """The surface of a face, or the curve of an edge, with its keyword."""
        ((keyword, arguments),) = self.entities[item.number].items()
        assert keyword in ("ADVANCED_FACE", "EDGE_CURVE")
        place = 2 if keyword == "ADVANCED_FACE" else 3
        ((keyword, arguments),) = self.entities[arguments[place].number].items()
        if keyword == "SURFACE_CURVE":  # the curve in space, then those on both faces
            ((keyword, arguments),) = self.entities[arguments[1].number].items()
        return keyword, arguments

    def surface(self, face):
        keyword, arguments = self.geometry(face)
        return keyword, arguments[2] if keyword in ("CYLINDRICAL_SURFACE", "SPHERICAL_SURFACE") else 0.0

    def place(self, face):
        """The keyword of a surface or curve, a point of it or its axis, its normal or axis, its radius."""
        keyword, radius = self.surface(face)
        _, arguments = self.geometry(face)
        if keyword == "LINE":
            direction = self.get(self.get(arguments[2], "VECTOR")[1], "DIRECTION")
            return keyword, tuple(self.get(arguments[1], "CARTESIAN_POINT")[1]), tuple(direction[1]), radius
        point, axis, _ = self.get(arguments[1], "AXIS2_PLACEMENT_3D")[1:]
        return (
            keyword,
            tuple(self.get(point, "CARTESIAN_POINT")[1]),
            tuple(self.get(axis, "DIRECTION")[1]),
            radius,
        )

    def lines(self):
        """The lines drawn for every dimension, by its name, as pairs of points in the axes of the file."""
        names = {}
        for number in self.of["DIMENSIONAL_CHARACTERISTIC_REPRESENTATION"]:
            dimension, representation = self.entities[number]["DIMENSIONAL_CHARACTERISTIC_REPRESENTATION"]
            names[dimension] = self.get(representation, "SHAPE_DIMENSION_REPRESENTATION")[0]
        first = self.of["SHAPE_DEFINITION_REPRESENTATION"][0]
        _, root = self.entities[first]["SHAPE_DEFINITION_REPRESENTATION"]
        for number in self.of["DRAUGHTING_MODEL_ITEM_ASSOCIATION"]:
            _, _, dimension, model, callout = self.entities[number]["DRAUGHTING_MODEL_ITEM_ASSOCIATION"]
            ((_, (_, _, axes)),) = self.entities[root.number].items()
            assert self.get(model, "DRAUGHTING_MODEL")[2] == axes
            if dimension in names:
                yield names[dimension], list(self._segments(callout))

    def _segments(self, callout):
        for occurrence in self.get(callout, "DRAUGHTING_CALLOUT")[1]:
            drawn = self.get(occurrence, "TESSELLATED_ANNOTATION_OCCURRENCE")[2]
            for curves in self.get(drawn, "TESSELLATED_GEOMETRIC_SET")[1]:
                _, points, pairs = self.get(curves, "TESSELLATED_CURVE_SET")
                at = self.get(points, "COORDINATES_LIST")[2]
                yield from ([at[int(n) - 1] for n in pair] for pair in pairs)

    def tolerances(self):
        """Name, kind, width and datums of every geometric tolerance."""
        for kind in ("CYLINDRICITY", "PERPENDICULARITY", "PARALLELISM"):
            for number in self.of[f"{kind}_TOLERANCE"]:
                parts = self.entities[number]
                arguments = parts.get("GEOMETRIC_TOLERANCE") or parts[f"{kind}_TOLERANCE"]
                ((width,),) = self.get(arguments[2], "LENGTH_MEASURE_WITH_UNIT")[1:2]
                datums = parts.get("GEOMETRIC_TOLERANCE_WITH_DATUM_REFERENCE", [[]])[0]
                yield arguments[0], kind.lower(), width, [self.letter(datum) for datum in datums]

    def letter(self, system):
        (compartment,) = self.get(system, "DATUM_SYSTEM")[4]
        return self.get(self.get(compartment, "DATUM_REFERENCE_COMPARTMENT")[4], "DATUM")[4]

    def properties(self):
        """Values of every property, by its name, its description and the entity that it is of."""
        for number in self.of["PROPERTY_DEFINITION_REPRESENTATION"]:
            definition, representation = self.entities[number]["PROPERTY_DEFINITION_REPRESENTATION"]
            name, what, _ = self.get(definition, "PROPERTY_DEFINITION")
            yield name, what, [self.item(i) for i in self.get(representation, "REPRESENTATION")[1]]

    def item(self, ref):
        ((keyword, arguments),) = self.entities[ref.number].items()
        return {
            "MEASURE_REPRESENTATION_ITEM": lambda: arguments[2][0],
            "DESCRIPTIVE_REPRESENTATION_ITEM": lambda: (arguments[0], arguments[1]),
            "CARTESIAN_POINT": lambda: arguments[1],
        }[keyword]()
