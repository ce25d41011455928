"""A design as its user wrote it: parameters, steps, models, iterations. A revision stores this document.

Values stay as typed: a quantity, a relation that begins with `=`, or a list of quantities and relations.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from itertools import chain
from typing import Annotated, Literal, Self

from pydantic import (
    AfterValidator,
    BeforeValidator,
    ConfigDict,
    Field,
    SerializerFunctionWrapHandler,
    StringConstraints,
    model_serializer,
    model_validator,
)
from pydantic_core import PydanticCustomError

from app.designs.variants.names import MOST_OVERRIDES, MOST_VARIANTS, PLACE, natural
from app.plain import Json, JsonObject, Raw
from app.schemas.bounds import Bounded, at_most
from app.schemas.values import Given, Limits
from app.solids.questions import Options

WORD = r"^[A-Za-z][A-Za-z0-9_]{0,63}$"
Word = Annotated[str, StringConstraints(pattern=WORD)]
NAME = r"^[^\x00-\x1f\x7f]+$"  # no control characters
Name = Annotated[str, StringConstraints(min_length=1, max_length=200, pattern=NAME)]
Version = Annotated[int, Field(ge=1, le=10**6)] | Literal["latest"] | None
Values = Annotated[dict[Word, Given], Field(max_length=500), at_most(500)]
CRITERION = r"^[A-Za-z][A-Za-z0-9_]{0,63}(\.[A-Za-z][A-Za-z0-9_]{0,63})?$"
CriterionName = Annotated[str, StringConstraints(pattern=CRITERION)]
"""A criterion of the design (`film`), or of the template of a step (`film.pressure`)."""
Sentence = Annotated[str, StringConstraints(min_length=1, max_length=500, pattern=NAME)]
Place = Annotated[str, StringConstraints(pattern=PLACE)]
Overrides = Annotated[dict[Place, Given], Field(max_length=500), at_most(500)]
"""The values of a variant by parameter, `step.input` or `model.parameter`."""
MOST_CRITERIA = 100
MOST_VALUES = 10_000  # largest total number of values that steps and models may set

_STRICT = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)


class Step(Bounded):
    """A template used in a design; a step without a version is pinned to the latest one when it is added."""

    model_config = _STRICT

    template: Word
    version: Version = None
    level: str | None = None
    tolerance: float | None = Field(None, gt=0, lt=1)
    inputs: Values = {}
    outputs: Annotated[list[Word], Field(max_length=200)] | None = Field(
        None, description="compute only these outputs; all, if not given"
    )
    limits: Limits = {}

    @model_serializer(mode="wrap")
    def without_nothing(self, plain: SerializerFunctionWrapHandler) -> JsonObject:
        """Remove an empty `limits` member, so that equal documents have one stored form."""
        return _without_nothing(plain(self), "limits")


class Model(Bounded):
    """A CAD model in a design."""

    model_config = _STRICT

    id: Word
    version: Version = None
    parameters: Values = {}
    analyses: Annotated[dict[Word, Options], Field(max_length=10), at_most(10)] = Field(
        {}, description="analyses of its solid for use in relations", examples=[{"torsion": {}}]
    )

    @model_serializer(mode="wrap")
    def without_nothing(self, plain: SerializerFunctionWrapHandler) -> JsonObject:
        """Remove an empty `analyses` member, so that equal documents have one stored form."""
        return _without_nothing(plain(self), "analyses")


class Iteration(Bounded):
    """A loop that the user allows: the measurement or analysis output to repeat, a start, a tolerance."""

    model_config = _STRICT

    through: str = Field(
        max_length=200, pattern=r"^[A-Za-z][A-Za-z0-9_]*(\.[a-z_]+){1,2}$", examples=["model.mass"]
    )
    start: Given = Field(examples=["3 kg"])
    tolerance: float = Field(1e-4, ge=1e-9, lt=1, description="relative")
    limit: int = Field(20, ge=1, le=100, description="rounds")


class WrittenCriterion(Bounded):
    """A criterion of the design itself, or changes to a criterion of one of its templates."""

    model_config = _STRICT

    require: str | None = Field(
        None,
        min_length=1,
        max_length=2000,
        description="two sides and one `>=` or `<=`, such as `film.minimum_film_thickness >= 3 um`; "
        "not needed for a criterion of a template",
    )
    words: Sentence | None = Field(None, description="what it means")
    source: Sentence | None = Field(None, description="source of the limit or of the rule")
    waived: Sentence | None = Field(None, description="why it is waived; it is still judged")

    @model_serializer(mode="wrap")
    def without_nothing(self, plain: SerializerFunctionWrapHandler) -> JsonObject:
        """Remove members that are null or empty."""
        return _without_nothing(plain(self), *type(self).model_fields)


MOST_COLUMNS = 40
COLUMN = r"^[A-Za-z][A-Za-z0-9_]{0,63}(\.[A-Za-z][A-Za-z0-9_]{0,63}){0,2}(\[[1-9][0-9]{0,5}\])?$"
ColumnName = Annotated[str, StringConstraints(pattern=COLUMN)]
"""A parameter, `step.output`, an item of a list `step.output[1]`, `model.mass`, `model.analysis.output`."""


class TableOfResults(Bounded):
    """The columns of the table in which variants are compared, in their order."""

    model_config = _STRICT

    columns: Annotated[list[ColumnName], Field(max_length=MOST_COLUMNS)] = Field(
        [],
        description="values of the design; if empty, the results that its templates name",
        examples=[["film.speed", "film.minimum_film_thickness", "shell.mass"]],
    )
    changes: bool = Field(False, description="whether each row also shows its change from the first row")

    @model_serializer(mode="wrap")
    def without_nothing(self, plain: SerializerFunctionWrapHandler) -> JsonObject:
        """Remove members that are empty or false, so that equal documents have one stored form."""
        return _without_nothing(plain(self), "columns", "changes")


WORKSHEET = "worksheet"
"""The block of a design that its own lines make; criteria and relations use `worksheet.name`."""
LONGEST_WORKSHEET = 16 * 1024
"""Most characters of its text; a save reads it in the server, which takes up to a third of a second."""


def _not_too_long(text: object) -> object:
    """Refuse a worksheet with too many characters, and say where longer texts belong."""
    if isinstance(text, str) and len(text) > LONGEST_WORKSHEET:
        message = (
            "the lines have {count} characters, and a design takes at most {most}; "
            "put the longer part into a worksheet of its own, and add it as a step"
        )
        raise PydanticCustomError("string_too_long", message, {"count": len(text), "most": LONGEST_WORKSHEET})
    return text


class AssumedValue(Bounded):
    """A value that was proposed for a parameter, and not given by a person who knows it."""

    model_config = _STRICT

    value: Given = Field(
        description="the proposed value, as the parameter states it", examples=["= 0.65 * bore"]
    )
    source: Sentence = Field(description="where the proposal comes from", examples=["customary"])


def _in_natural_order(variants: dict[str, dict[str, Raw]]) -> dict[str, dict[str, Raw]]:
    """Return variants in natural order of their names: main_2 before main_10."""
    return {name: variants[name] for name in sorted(variants, key=natural)}


class Document(Bounded):
    """The complete input of a design, as stored in a revision."""

    model_config = _STRICT

    name: Name
    parameters: Values = {}
    steps: Annotated[dict[Word, Step], Field(max_length=100), at_most(100)] = {}
    models: Annotated[dict[Word, Model], Field(max_length=20), at_most(20)] = {}
    iterations: Annotated[list[Iteration], Field(max_length=10)] = []
    criteria: Annotated[
        dict[CriterionName, WrittenCriterion], Field(max_length=MOST_CRITERIA), at_most(MOST_CRITERIA)
    ] = Field(
        {}, description="criteria of the design; `step.name` overrides or waives a criterion of a template"
    )
    variants: Annotated[
        dict[Word, Overrides],
        Field(max_length=MOST_VARIANTS),
        at_most(MOST_VARIANTS),
        AfterValidator(_in_natural_order),
    ] = Field(
        {},
        description="named sets of values that override parameters, inputs of steps and parameters of models",
        examples=[{"main_1": {"clearance": "55 um"}, "main_2": {"film.bearing_width": "= width - 2 mm"}}],
    )
    table: TableOfResults = Field(TableOfResults(), description="the table in which variants are compared")
    assumed: Annotated[dict[Word, AssumedValue], Field(max_length=500), at_most(500)] = Field(
        {},
        description="proposed values by parameter; a parameter is assumed as long as it has this value",
    )
    worksheet: Annotated[str, BeforeValidator(_not_too_long)] = Field(
        "",
        max_length=LONGEST_WORKSHEET,
        description="lines in the language of worksheets: formulas, checks and plots of the design's values; "
        "their results are `worksheet.name`, where the words of a line give the name",
        examples=['r [1] = film.minimum_film_thickness / 2 um "film ratio"\ncheck r >= 1.5 "enough film"'],
    )

    @model_serializer(mode="wrap")
    def without_nothing(self, plain: SerializerFunctionWrapHandler) -> JsonObject:
        """Remove empty optional members, so that equal documents have one stored form."""
        return _without_nothing(plain(self), "criteria", "variants", "table", "assumed", "worksheet")

    @model_validator(mode="before")
    @classmethod
    def one_model(cls, raw: Raw) -> Raw:
        """Replace `model` with `models`, which has one entry, named `model`."""
        if not isinstance(raw, Mapping):
            return raw
        if "model" in raw and "models" in raw:
            raise ValueError("give either `model` or `models`, not both")
        whole = _in_models(raw)
        if _values_set(whole) > MOST_VALUES:
            raise ValueError(f"the steps and models of a design set at most {MOST_VALUES} values in total")
        if _overrides_set(whole) > MOST_OVERRIDES:
            raise ValueError(f"the variants of a design override at most {MOST_OVERRIDES} values together")
        return whole

    @model_validator(mode="after")
    def names_differ(self) -> Self:
        """Require that parameters, steps and models all have different names."""
        count = Counter(chain(self.parameters, self.steps, self.models))
        twice = sorted(name for name, times in count.items() if times > 1)
        if self.worksheet and WORKSHEET in count:
            raise ValueError("the design has a `worksheet` of its own: rename the value of this name")
        if twice:
            raise ValueError(f"{', '.join(twice)} names more than one parameter, step or model")
        return self


def _without_nothing(plain: JsonObject, *names: str) -> JsonObject:
    """Return an object without its empty members."""
    return {name: value for name, value in plain.items() if value or name not in names}


def _values_set(raw: Mapping[str, Raw]) -> int:
    """Return the number of values that steps and models set; it accepts a malformed document too."""
    places = (("steps", "inputs"), ("steps", "limits"), ("models", "parameters"))
    groups = [(group, part) for name, part in places if isinstance(group := raw.get(name), Mapping)]
    blocks = [(block, part) for group, part in groups for block in group.values()]
    inside = [block.get(part) for block, part in blocks if isinstance(block, Mapping)]
    return sum(len(values) for values in inside if isinstance(values, Mapping))


def _overrides_set(raw: Mapping[str, Raw]) -> int:
    """Return the number of values that variants override; it accepts a malformed document too."""
    variants = raw.get("variants")
    inside = variants.values() if isinstance(variants, Mapping) else ()
    return sum(len(values) for values in inside if isinstance(values, Mapping))


def _in_models(raw: Mapping[str, Raw]) -> Mapping[str, Json]:
    """Return a document with `model` moved into `models`; unchanged if it has no `model`, or has both."""
    if "model" not in raw or "models" in raw:
        return raw
    rest = {key: value for key, value in raw.items() if key != "model"}
    return {**rest, "models": {"model": raw["model"]}}


StoredDocument = JsonObject
"""A document as a revision stores it: `Document.model_dump` in JSON mode, by any version of the program."""


def assumed_values(document: StoredDocument) -> JsonObject:
    """Return the proposed values that parameters of a stored document still have, by parameter."""
    parameters, proposed = document.get("parameters", {}), document.get("assumed", {})
    return {name: one for name, one in proposed.items() if parameters.get(name) == one["value"]}


def merge(document: Mapping[str, Json], patch: Mapping[str, Raw]) -> JsonObject:
    """Return the document with a merge patch applied (RFC 7396).

    A quantity is always replaced as a whole.
    """
    return dict(_merged(document, _in_models(patch), ()))


def _merged(old: Json, patch: Json, path: tuple[str, ...]) -> Json:
    if not isinstance(patch, Mapping) or not _is_container(path):
        return patch
    result = dict(old) if isinstance(old, Mapping) else {}
    for key, value in patch.items():
        if value is None:
            result.pop(key, None)
        else:
            result[key] = _merged(result.get(key), value, (*path, key))
    return result


def _is_container(path: tuple[str, ...]) -> bool:
    """Return whether a patch is merged into a value instead of replacing it.

    The document, its groups, its steps and models, and their parts are containers.
    """
    match path:
        case () | ("parameters" | "steps" | "models" | "criteria" | "variants" | "table" | "assumed",):
            return True
        case ("steps" | "models" | "variants", _):
            return True
        case ("steps", _, "inputs" | "limits") | ("models", _, "parameters" | "analyses"):
            return True
        case ("models", _, "analyses", _):
            return True
    return False
