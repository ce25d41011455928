"""Slopes of volume, mass, centre, inertia and box of a solid over the parameters of its model.

A parameter moves the faces of a solid. If v is the normal velocity of its faces, the slope of ∫ f dV is
∫ f v dA over all faces (Hadamard). Each face lies on a face of an operand of a Boolean operation, whose
plane, cylinder, cone, sphere or torus is read at values of the parameter beside its own. So no Boolean
operation is done again, and the slopes over one parameter cost little more than one build.

References
----------
Delfour and Zolésio 2011: Shapes and Geometries, 2nd edition, chapter 9: derivative of a domain integral.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cad.inspect import MEASURES, Number, Numbers, Standing, mass_measures
from cad.model import CadModel, Part
from cad.slopes.carriers import OTHER, Carriers, distance, distance_rate, gradient
from cad.slopes.face_integrals import FaceQuadrature, quadrature
from cad.slopes.operands import operands
from cad.slopes.results import ParameterSlopes, SolidSlopes
from cad.slopes.variations import Draw, Drawing, Variation, drawing, faces_of, variation
from templates.core.arrays import Array
from templates.core.language.spec import Curve

_COINCIDENT = 1e-6  # largest distance of a face from its carrier [mm]
_SAMPLES = 12  # points of a face by which its carrier is recognised
_NEGLIGIBLE = 1e-7  # of a difference of slopes, relative to the size of the solid
_AGREE = 1e-5  # relative difference of two slopes that count as equal
BOX = tuple(f"{side}_{axis}" for side in ("low", "high") for axis in "xyz")


def solid_slopes(model: CadModel, parameters: Collection[str] | None = None) -> SolidSlopes:
    """Return the measures of a model's solid and their slopes over some parameters, by default over all.

    Raises
    ------
    GeometryError
        If the model cannot be built.
    """
    names = [name for name in model.inputs if parameters is None or name in parameters]
    try:
        solid = Solid.of(model)
    except Untraced as error:
        return SolidSlopes({}, {name: ParameterSlopes(whole=str(error)) for name in names})
    return SolidSlopes(solid.measures, {name: _over(model, name, solid) for name in names})


def _over(model: CadModel, name: str, solid: Solid) -> ParameterSlopes:
    if reason := _not_single(model, name):
        return ParameterSlopes(whole=reason)
    return solid.slopes(variation(model, name, solid.drawing, solid.draw))


def _not_single(model: CadModel, name: str) -> str:
    """Return why a parameter has no slopes whatever the solid; an empty text if it may have them."""
    value, declared = model.inputs_si()[name], model.inputs[name]
    if isinstance(value, str):
        return "it is a choice"
    if isinstance(declared, Curve) or np.ndim(value):
        return "it is a list"
    return "it is a whole number" if declared.meaning.integer else ""


class Carrier(NamedTuple):
    """The carrier of a face among those of its part: its number, and 1 if its normal is outward, else -1."""

    number: int
    side: int


class TracedFace(NamedTuple):
    """A face of the solid, and the faces of operands on whose carriers it lies.

    `samples` are some points of its carrier; `weighted` are 1, x and x xᵀ at its points times the weights of
    its quadrature, shape (n, 10).
    """

    name: str
    points: Array
    weighted: Array
    samples: Array
    carriers: tuple[Carrier, ...]


class Moments(NamedTuple):
    """The integrals of 1, x and x xᵀ over a part: shapes (), (3,) and (3, 3)."""

    volume: Number
    first: Numbers
    second: Numbers

    @classmethod
    def of(cls, row: Numbers) -> Moments:
        """Return the moments in a row of ten numbers."""
        second = np.empty((3, 3), dtype=row.dtype)
        second[_PAIRS] = second[_PAIRS[::-1]] = row[4:]
        return cls(complex(row[0]), row[1:4], second)

    def standing(self, place: Numbers, density: Number) -> Standing:
        """Return mass, centre and inertia of the part at a position (3, 4), at a density [kg/mm³]."""
        turn, shift = place[:, :3], place[:, 3]
        centre = self.first / self.volume
        central = self.second - self.volume * np.outer(centre, centre)
        inertia = np.trace(central) * np.eye(3) - central
        return density * self.volume, turn @ centre + shift, density * turn @ inertia @ turn.T


_PAIRS = np.triu_indices(3)


class Untraced(Exception):
    """Why the movement of a face is not known."""


@dataclass(frozen=True)
class Solid:
    """A built model whose faces are traced to the operands of its Boolean operations.

    Attributes
    ----------
    drawing, draw
        The operands, and the function that draws them.
    faces, moments
        For each part its faces and its moments (10,).
    """

    drawing: Drawing
    draw: Draw
    faces: tuple[tuple[TracedFace, ...], ...]
    moments: tuple[Array, ...]

    @classmethod
    def of(cls, model: CadModel) -> Solid:
        """Return the solid of a model.

        Where the faces cannot be traced to operands, as after a fillet on an edge that an operation made,
        they are traced to the parts themselves, which are then built for each value of a parameter.

        Raises
        ------
        Untraced
            If a face is of another kind.
        """
        rules = {part.name: _rules(part) for part in model.build()}
        try:
            return cls._traced(drawing(model, operands), operands, rules)
        except Exception:  # a team's model may do anything with the result of an operation
            return cls._traced(drawing(model, _built), _built, rules)

    @classmethod
    def _traced(cls, drawn: Drawing, draw: Draw, rules: Mapping[str, Sequence[FaceQuadrature]]) -> Solid:
        faces = tuple(
            tuple(
                _traced(f"face {number} of {part.name}", rule, part.carriers)
                for number, rule in enumerate(rules[part.name], 1)
            )
            for part in drawn.parts
        )
        return cls(drawn, draw, faces, tuple(_moments(rules[part.name]) for part in drawn.parts))

    @property
    def measures(self) -> dict[str, float]:
        """Return the measures of the solid."""
        still = self._changed(np.zeros_like(self.drawing.numbers))
        return {name: float(np.real(value)) for name, value in still.items()}

    def slopes(self, varied: Variation) -> ParameterSlopes:
        """Return the slopes over a parameter, whose variation is given."""
        if varied.rates is None:
            return ParameterSlopes(whole=varied.reason)
        try:
            slopes, reasons = self._rates(varied.rates), dict[str, str]()
            if varied.ends is not None:
                below, above = (self._rates(end) for end in varied.ends)
                reasons = dict(self._kinks(below, above, varied.span))
        except Untraced as error:
            return ParameterSlopes(whole=str(error))
        kept = {name: slope for name, slope in slopes.items() if name not in reasons}
        return ParameterSlopes(kept, reasons, varied.side, varied.reason)

    def _kinks(
        self, below: Mapping[str, float], above: Mapping[str, float], span: float
    ) -> Iterator[tuple[str, str]]:
        """Yield each measure whose slopes below and above the value differ, with the reason."""
        size = float(np.linalg.norm(self.drawing.box[3:] - self.drawing.box[:3]))
        measures = self.measures
        for name, low in below.items():
            high = above[name]
            scale = {"volume": measures["volume"], "mass": measures["mass"]}.get(name, size)
            if MEASURES[name] == "kg*m**2":
                scale = measures["mass"] * size**2 * 1e-6
            if abs(high - low) > max(_AGREE * max(abs(low), abs(high)), _NEGLIGIBLE * scale / span):
                yield name, "its slope is another above the value than below"

    def _rates(self, rates: Array) -> dict[str, float]:
        """Return the slopes of the measures for rates of the drawing's numbers.

        Raises
        ------
        Untraced
            If faces of operands coincide and move apart.
        """
        changed = self._changed(rates)
        return {name: float(np.imag(value)) / _SMALL for name, value in changed.items()}

    def _changed(self, rates: Array) -> dict[str, Number]:
        """Return the measures after a small imaginary change of the drawing's numbers."""
        volume, standing = 0.0 + 0.0j, list[Standing]()
        moving = self.drawing.with_numbers(rates)
        for part, change, faces, row in zip(
            self.drawing.parts, moving.parts, self.faces, self.moments, strict=True
        ):
            rows = [_swept(face, part.carriers, change.carriers.numbers) for face in faces]
            moments = Moments.of(row + 1j * _SMALL * np.sum(rows, axis=0))
            density = (part.density + 1j * _SMALL * change.density) * 1e-9
            places = part.places + 1j * _SMALL * change.places
            standing += [moments.standing(place, density) for place in places]
            volume += moments.volume * len(places)
        box = self.drawing.box + 1j * _SMALL * moving.box
        return mass_measures(volume, standing) | dict(zip(BOX, box.tolist(), strict=True))


_SMALL = 1e-30  # of the change: so small that its square vanishes beside 1 (complex step)


def _built(model: CadModel) -> Sequence[Part]:
    return model.build()


def _rules(part: Part) -> list[FaceQuadrature]:
    """Return the quadratures of the faces of a part.

    Raises
    ------
    Untraced
        If a face is of another kind.
    """
    faces = faces_of(part.solid.wrapped)
    kinds = Carriers.of(faces).kinds.tolist()
    if OTHER in kinds:
        which = f"face {kinds.index(OTHER) + 1} of {part.name}"
        raise Untraced(f"{which} is no plane, cylinder, cone, sphere or torus")
    return [quadrature(face) for face in faces]


def _traced(name: str, rule: FaceQuadrature, carriers: Carriers) -> TracedFace:
    """Return a face with all carriers on which it lies.

    Raises
    ------
    Untraced
        If there is none.
    """
    few = np.linspace(0, len(rule.points) - 1, _SAMPLES).astype(int)
    samples, normals = rule.points[few], rule.normals[few]
    alike = np.flatnonzero(carriers.kinds == rule.kind)
    away = np.abs(distance(rule.kind, carriers.numbers[alike], samples)).max(axis=1, initial=0.0)
    matching = []
    for number in alike[away < _COINCIDENT].tolist():
        along = np.sum(gradient(rule.kind, carriers.numbers[number], samples) * normals, axis=1)
        if np.all(np.abs(np.abs(along) - 1) < _COINCIDENT):
            matching.append(Carrier(number, int(np.sign(along[0]))))
    if not matching:
        raise Untraced(f"{name} lies on no face of an operand")
    powers = _powers(rule.points)
    return TracedFace(name, rule.points, powers * rule.weights[:, None], samples, tuple(matching))


def _powers(points: Array) -> Array:
    """Return 1, x and the upper triangle of x xᵀ at points (n, 3), shape (n, 10)."""
    i, j = _PAIRS
    return np.column_stack([np.ones(len(points)), points, points[:, i] * points[:, j]])


def _moments(rules: Sequence[FaceQuadrature]) -> Array:
    """Return the moments of a part (10,) by the divergence theorem.

    A monomial f of degree d has ∇·(x f) = (d + 3) f.
    """
    degrees = np.array([3.0] + [4.0] * 3 + [5.0] * 6)
    rows = [
        (np.sum(rule.points * rule.normals, axis=1) * rule.weights) @ _powers(rule.points) for rule in rules
    ]
    return np.asarray(np.sum(rows, axis=0) / degrees)


def _swept(face: TracedFace, carriers: Carriers, rates: Array) -> Array:
    """Return the rates of a part's moments (10,) that come from the movement of one face.

    Raises
    ------
    Untraced
        If the face lies on faces of operands that move apart.
    """
    first, *others = face.carriers
    if any(not np.array_equal(rates[first.number], rates[other.number]) for other in others):
        _require_together(face, carriers, rates)
    if not rates[first.number].any():
        return np.zeros(10)
    return np.asarray(_velocity(first, carriers, rates, face.points) @ face.weighted)


def _velocity(carrier: Carrier, carriers: Carriers, rates: Array, points: Array) -> Array:
    """Return the outward normal velocity of a carrier at points of it."""
    kind, numbers = int(carriers.kinds[carrier.number]), carriers.numbers[carrier.number]
    return -carrier.side * distance_rate(kind, numbers, rates[carrier.number], points)


def _require_together(face: TracedFace, carriers: Carriers, rates: Array) -> None:
    """Raise Untraced if the carriers of a face have different velocities."""
    every = np.array([_velocity(one, carriers, rates, face.samples) for one in face.carriers])
    if np.ptp(every, axis=0).max() > _AGREE * max(1.0, float(np.abs(every).max())):
        raise Untraced(f"{face.name} is where faces of the shape coincide and move apart")
