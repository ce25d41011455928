"""Arguments of the tools, and their schemas: short, because a client reads them with every task."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue, ValidationError
from pydantic.json_schema import SkipJsonSchema

from templates.core.errors import plain

Kind = Literal["template", "model", "design", "table"]
Id = Annotated[str, Field(pattern="^[A-Za-z0-9_-]{1,64}$")]
Text = Annotated[str, Field(max_length=300)]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)*$", max_length=200)]
Values = dict[Annotated[str, Field(max_length=200)], JsonValue]
Version = Annotated[int, Field(ge=1, le=10**6)]
LONGEST_FILE = 16 * 2**20  # characters of a file in base64


class Arguments(BaseModel):
    """Arguments of a tool; an unknown name is refused."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)

    @classmethod
    def input_schema(cls) -> dict[str, object]:
        """Return the JSON Schema with names, types, choices and descriptions only."""
        schema = cls.model_json_schema()
        parts = {name: _short(part) for name, part in schema["properties"].items()}
        needed = {"required": schema["required"]} if "required" in schema else {}
        return {"type": "object", "properties": parts, **needed, "additionalProperties": False}


class Find(Arguments):
    """Words to search for, and the kind of thing."""

    words: Annotated[str, Field(min_length=1, max_length=200)]
    kind: Kind | SkipJsonSchema[None] = None


class Explain(Arguments):
    """A template, model, table or design, and a name in it."""

    id: Id
    kind: Kind = "template"
    version: Version | SkipJsonSchema[None] = None
    name: Name | SkipJsonSchema[None] = None


class Evaluate(Arguments):
    """A template with inputs, or a design with changed values."""

    template: Id | SkipJsonSchema[None] = None
    version: Version | SkipJsonSchema[None] = None
    inputs: Values = {}
    limits: Values = {}
    outputs: Annotated[list[Text], Field(max_length=50)] = []
    level: Text | SkipJsonSchema[None] = None
    design: Id | SkipJsonSchema[None] = None
    change: Values = Field({}, description="merge patch of the design")


class Answer(Arguments):
    """A design, its free places and the requirements, as `POST /answer` takes them."""

    design: Id | Values = Field(description="id, gallery name, or document")
    free: Values = Field(
        description="{'film.bearing_width': {'between': ['15 mm', '40 mm'], 'step': '1 mm'}}"
    )
    require: Annotated[list[Text], Field(max_length=50)] | SkipJsonSchema[None] = Field(
        None, description="criteria, or 'film.minimum_film_thickness >= 3 um'"
    )
    targets: Values = {}
    minimise: Text | SkipJsonSchema[None] = None
    maximise: Text | SkipJsonSchema[None] = None
    others: Values = Field({}, alias="with", description="values that replace those of the design")
    set_aside: Annotated[list[Text], Field(max_length=10)] = []
    tolerance: float | SkipJsonSchema[None] = None


class Verify(Arguments):
    """A design whose criteria are decided at finer levels, or a STEP file."""

    design: Id | SkipJsonSchema[None] = None
    criteria: Annotated[list[Text], Field(max_length=50)] = []
    file: Annotated[str, Field(max_length=LONGEST_FILE)] | SkipJsonSchema[None] = Field(
        None, description="base64, or a crankwright:// link"
    )


class Report(Arguments):
    """A design and a revision."""

    design: Id
    revision: Version | SkipJsonSchema[None] = None


class Propose(Arguments):
    """A new design, or a change of a design."""

    document: Values = Field({}, description="a new design")
    design: Id | SkipJsonSchema[None] = None
    change: Values = Field({}, description="merge patch")
    note: Text = ""


def faults(error: ValidationError) -> str:
    """Return what is wrong with arguments, one argument a line, without the values that the caller sent."""
    messages: dict[str, str] = {}
    for one in error.errors(include_url=False, include_context=False, include_input=False):
        messages.setdefault(plain(str(one["loc"][0]) if one["loc"] else "arguments"), one["msg"])
    return "\n".join(f"{name}: {text}" for name, text in [*messages.items()][:10])


SHOWN = ("type", "enum", "description")
"""What a client sees of an argument; the bounds that it does not see, a refusal states."""


def _short(schema: Mapping[str, object]) -> dict[str, object]:
    """Return the schema of an argument, as short as it can be."""
    items = schema.get("items")
    inner = {"items": _short(items)} if isinstance(items, dict) else {}
    return {name: schema[name] for name in SHOWN if name in schema} | inner
