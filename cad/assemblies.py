"""Assemblies that a team defines: a model of this program with added fixed parts, or fixed parts alone.

The class of an assembly is the class of its model with six more parameters for each fixed part: its position
on its datum. The model's own parts pass the usual checks. A fixed part is the shape of a STEP file, and its
volume is measured. No fixed part may interfere with another part, unless its description allows that.

This module imports the kernel only when it builds a shape.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import TYPE_CHECKING, Any, ClassVar

from cad.catalogue import models
from cad.errors import GeometryError, UnreadableStep
from cad.imported_models import Description, ImportedModel, Parameter, attribute_of, parts_of_step
from cad.model import BETWEEN, Box, CadModel, Dimension, Part
from cad.shaft import STEEL_DENSITY
from templates.core.errors import listed, plain
from templates.core.nearest import nearest

if TYPE_CHECKING:
    from cad.fillets import Crank
    from cad.placement import Place
    from cad.shaft import Shaft

MOST_COMPONENTS = 30
MOST_SOLIDS = 300
"""Largest number of solids of all fixed parts; each counts as often as it occurs in its file."""
FARTHEST = 1e5
"""Largest distance of a fixed part from its datum along each axis [mm]."""
SHIFTS, TURNS = ("x", "y", "z"), ("turn_x", "turn_y", "turn_z")
_DRAWN, _PARTS = "as drawn", "parts as drawn"  # a declaration cannot have these names
_WITHIN = ":"  # separates the name of a fixed part from that of one of its solids


@dataclass(frozen=True)
class Component:
    """A fixed part: its STEP file, and the datum of its position."""

    name: str
    file: str  # SHA-256 of its STEP file
    origin: str  # in words: "model m8_bolt version 1"
    datum: str = "origin"  # as `cad.placement` reads it
    may_overlap: tuple[str, ...] = ()  # names of parts and components
    density: float = STEEL_DENSITY  # [kg/m³]
    material: str = ""
    holds: tuple[str, ...] = ()  # ids of the models from which it is built

    def parameters(self, numbers: Mapping[str, float]) -> Iterator[Parameter]:
        """Return the position of the part as parameters of the assembly, with their default values."""
        for key in (*SHIFTS, *TURNS):
            unit, bound = ("mm", FARTHEST) if key in SHIFTS else ("deg", 360.0)
            words = f"{self.name} {key.replace('_', ' about ')}".replace("_", " ")
            source = f"{self.name}.{key}"
            name, number = f"{self.name}_{key}", numbers.get(key, 0.0)
            yield Parameter(name, words, unit, number, source, low=-bound, high=bound)


@dataclass(frozen=True)
class AssemblyDescription(Description):
    """Complete description of an assembly, from which its class is created."""

    base: tuple[str, int] | None = None  # id and version of a model of this program
    components: tuple[Component, ...] = ()

    def bases(self) -> tuple[type[CadModel], ...]:
        """Return the base classes: the class of assemblies, and the class of the base model."""
        return (AssemblyModel, *([base_of(self.base)] if self.base else []))

    def example(self) -> Mapping[str, Any]:
        """Return the example of the base model; the positions are those of the description."""
        return base_of(self.base).example if self.base else super().example()

    @property
    def trust(self) -> str:
        """Return in plain words which checks the solids do not pass through."""
        names = ", ".join(one.name for one in self.components)
        own = f"{self.base[0]} is checked as ever. " if self.base else ""
        return (
            f"lower: {own}Fixed parts ({names}) are the solids of their STEP files, without a formula for "
            "their volume. Their places, clearances and interferences are measured on the finished file"
        )


class AssemblyModel(ImportedModel):
    """Base class of the assemblies that a team defines."""

    imported: ClassVar[AssemblyDescription]

    def build(self) -> tuple[Part, ...]:
        """Return the parts of the base model, and the fixed parts at their positions."""
        if _PARTS not in vars(self):
            built = tuple(self._built())
            self._require_known(built)
            vars(self)[_PARTS] = built
        parts: tuple[Part, ...] = vars(self)[_PARTS]
        return parts

    def bounding_box(self) -> Box:
        """Return the bounding box of the base model and the fixed parts together."""
        from cad.inspect import bounding_box
        from cad.step import Body

        fixed = [part for part in self.build() if self.component_of(part.name)]
        boxes = [bounding_box(Body(one.name, one.solid, one.colour, one.places) for one in fixed)]
        if self.imported.base:
            boxes.append(super(ImportedModel, self).bounding_box())
        low, high = ([box.low for box in boxes], [box.high for box in boxes])
        return Box(
            (min(p[0] for p in low), min(p[1] for p in low), min(p[2] for p in low)),
            (max(p[0] for p in high), max(p[1] for p in high), max(p[2] for p in high)),
        )

    def dimensions(self, seen: Mapping[str, Any]) -> dict[str, Dimension]:
        """Return the parameters of the base model, as read back from its own parts."""
        if not self.imported.base:
            return {}
        own = {name: part for name, part in seen.items() if not self.component_of(name)}
        return dict(super(ImportedModel, self).dimensions(own))

    def component_of(self, part: str) -> str | None:
        """Return the fixed part to which a solid belongs; None for a solid of the base model."""
        name = part.partition(_WITHIN)[0]
        return name if any(name == one.name for one in self.imported.components) else None

    @classmethod
    def further_measures(cls) -> Mapping[str, str]:
        """Return the clearance and overlap of each fixed part, unless a parameter has that name."""
        measures = {
            f"{one.name}_{end}": unit for one in cls.imported.components for end, unit in BETWEEN.items()
        }
        return {name: unit for name, unit in measures.items() if name not in {*cls.inputs, *cls.formulas}}

    def known_overlaps(self) -> Collection[frozenset[str]] | None:
        """Return the pairs of solids of the base model that may overlap; None if all may."""
        return CadModel.known_overlaps(self)

    def may_overlap(self, one: str, other: str) -> bool:
        """Return whether the description allows two of its solids to overlap."""
        return self._allows(one, other) or self._allows(other, one)

    def movers(self, part: str) -> tuple[str, ...]:
        """Return the shifts of the fixed part to which a solid belongs, and its turns that are not 0."""
        if (component := self.component_of(part)) is None:
            return ()
        place = self.place(component)
        turns = [key for key in TURNS if getattr(place, key)]
        return tuple(f"{component}_{key}" for key in (*SHIFTS, *turns))

    def shaft(self) -> Shaft | None:
        """Return None, because finite-element analyses need a single solid, not an assembly."""
        return None

    @classmethod
    def is_throw(cls) -> bool:
        """Return False, because finite-element analyses need a single solid."""
        return False

    def throw_sizes(self) -> Crank | None:
        """Return None, because finite-element analyses need a single solid."""
        return None

    def _allows(self, one: str, other: str) -> bool:
        """Return whether the fixed part of one solid may overlap the other solid or its part."""
        name = self.component_of(one)
        component = next((c for c in self.imported.components if c.name == name), None)
        if component is None:
            return False
        parts = (part.name for part in self.build() if other in part.names)
        return not {other, self.component_of(other), *parts}.isdisjoint(component.may_overlap)

    def _require_known(self, parts: Sequence[Part]) -> None:
        """Refuse a `may_overlap` that names an unknown part.

        Parts that other parameters of the model create are known.

        Raises
        ------
        GeometryError
            `may_overlap`, with the nearest names and all existing ones.
        """
        wanted = {name: one.name for one in self.imported.components for name in one.may_overlap}
        known = dict.fromkeys(one.name for one in self.imported.components)
        for part in parts:
            known |= dict.fromkeys((part.name, *part.names))
        if not (unknown := wanted.keys() - known.keys()):
            return
        if self.imported.base:
            cls = base_of(self.imported.base)
            for part in cls.from_quantities(cls.example).build():
                unknown -= {part.name, *part.names}
        if not unknown:
            return
        name = min(unknown)
        near = nearest(name, list(known))
        meant = f"Did you mean {', '.join(near)}? " if near else ""
        there = listed([part.name for part in parts])
        wrong = f"{wanted[name]}: may_overlap names {plain(name)!r}, which is not a part"
        raise GeometryError("may_overlap", f"{wrong}. {meant}The parts are {there}")

    def _built(self) -> Iterator[Part]:
        from cad.placement import frame_of

        drawn = vars(self).get(_DRAWN)
        if drawn is None:
            raise GeometryError("kernel", f"{self.id} needs its fixed parts before it is built", self.inputs)
        there = dict[str, Part]()
        if self.imported.base:
            for part in super(ImportedModel, self).build():
                there[part.name] = part
                yield part
        count = 0
        for component in self.imported.components:
            if component.name in there:
                detail = f"{component.name} is the name of a part of {self._of_model()}: choose another"
                raise GeometryError("name", detail)
            at = frame_of(component.name, component.datum, there) * self.place(component.name).motion
            parts = _solids_of(component, drawn.fixed[component.file])
            count += sum(len(part.places) for part in parts)
            if count > MOST_SOLIDS:
                detail = f"the fixed parts have more than {MOST_SOLIDS} solids; remove some of them"
                raise GeometryError("too_large", detail)
            for number, part in enumerate(parts):
                placed = replace(part, places=tuple(at * place for place in part.places))
                there[part.name] = placed
                if number == 0:  # a datum may refer to the whole component
                    there[component.name] = placed
                yield placed

    def place(self, component: str) -> Place:
        """Return the position of a fixed part on its datum."""
        from cad.placement import Place

        numbers = dict[str, float]()
        for key in (*SHIFTS, *TURNS):
            name = f"{component}_{key}"
            si = float(getattr(self, attribute_of(name)))
            numbers[key] = round(float(self.inputs[name].meaning.scale.from_si(si)), 9) + 0.0
        return Place(**numbers)

    def _of_model(self) -> str:
        return self.imported.base[0] if self.imported.base else self.id


def _solids_of(component: Component, step: bytes) -> list[Part]:
    """Return the solids of a fixed part: a single one has the part's name, several have separate names."""
    try:
        parts = list(parts_of_step(step))
    except (UnreadableStep, GeometryError) as error:
        raise GeometryError("no_solid", f"{component.name} ({component.origin}): {error}") from None
    made_of = {"density": component.density, "material": component.material}
    is_single = len(parts) == 1 and len(parts[0].places) == 1
    return [
        replace(
            one,
            name=component.name if len(parts) == 1 else f"{component.name}{_WITHIN}{one.name}",
            called=() if is_single else tuple(f"{component.name}{_WITHIN}{name}" for name in one.called),
            **made_of,  # type: ignore[arg-type]
        )
        for one in parts
    ]


def base_of(base: tuple[str, int]) -> type[CadModel]:
    """Return the class of a model of this program, by id and version."""
    return models().get(*base)


def assembly_of(read: Mapping[str, Any]) -> AssemblyDescription:
    """Return the description in a JSON text; its parameters were parsed beforehand."""
    components = tuple(_component(one) for one in read["components"])
    base = read["base"]
    return AssemblyDescription(
        **{**read, "components": components, "base": (str(base[0]), int(base[1])) if base else None}
    )


def _component(read: dict[str, Any]) -> Component:
    lists: dict[str, Any] = {key: tuple(value) for key, value in read.items() if isinstance(value, list)}
    return Component(**{**read, **lists})


def described(
    title: str,
    file: str,
    file_name: str,
    base: tuple[str, int] | None,
    components: Mapping[Component, Mapping[str, float]],
) -> AssemblyDescription:
    """Return the description of an assembly; positions in `components` are plain numbers in mm and deg."""
    return AssemblyDescription(
        program="assembly",
        file=file,
        file_name=file_name,
        title=title,
        made_with="STEP",
        parameters=tuple(chain.from_iterable(one.parameters(at) for one, at in components.items())),
        base=base,
        components=tuple(components),
    )
