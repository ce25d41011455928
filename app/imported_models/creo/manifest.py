"""Parse the manifest of a Creo model: its file, and the dimensions and parameters to be driven."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, model_validator

from app.imported_models.manifests import LINE, NAME, STRICT, TITLE, read_manifest
from app.schemas.bounds import Bounded
from cad.imported_models import Description, Parameter

_PARAMETER = r"^[A-Za-z][A-Za-z0-9_-]*$"  # CREOSON refuses other names
MM: dict[str, float] = {"mm": 1.0, "inch": 25.4}


class Driven(Bounded):
    """One number of the model: a dimension or a parameter of Creo."""

    model_config = STRICT

    name: str = Field(max_length=60, pattern=NAME, description="name in relations")
    words: str = Field(
        "", max_length=100, pattern=LINE, description="meaning of the number; default: its name"
    )
    dimension: str | None = Field(
        None, min_length=1, max_length=80, pattern=LINE, description="symbol of the dimension in Creo: `D`"
    )
    parameter: str | None = Field(
        None, max_length=31, pattern=_PARAMETER, description="name of the parameter in Creo: `SCALE`"
    )
    unit: Literal["mm", "inch", "deg", "1"] = Field(description="its unit in Creo")
    value: float = Field(description="its value in the stored model")
    low: float = Field(description="smallest value that is sent to Creo")
    high: float = Field(description="largest value that is sent to Creo")
    check: Literal["diameter", "radius", "distance"] | None = Field(
        None, description="the size of every solid that is compared with it"
    )

    @model_validator(mode="after")
    def is_one_number(self) -> Self:
        """Require either a dimension or a parameter, with a value within its range.

        Raises
        ------
        ValueError
            If it is neither or both, or its value is out of range.
        """
        if (self.dimension is None) == (self.parameter is None):
            raise ValueError("give either the dimension or the parameter of Creo")
        if not self.low <= self.value <= self.high:
            raise ValueError(f"the value {self.value:g} is not between {self.low:g} and {self.high:g}")
        if self.check and self.unit not in MM:
            raise ValueError("only a length can be read back from the solid")
        return self

    def described(self) -> Parameter:
        """Return the entry as a parameter of the model."""
        kind, key = ("dimension", self.dimension) if self.dimension else ("parameter", self.parameter)
        return Parameter(
            name=self.name,
            words=self.words.strip() or self.name.replace("_", " "),
            unit=self.unit,
            value=self.value,
            source=f"{kind}.{key}",
            low=self.low,
            high=self.high,
            role=self.check or "",
        )


class Manifest(Bounded):
    """A model of Creo, and its dimensions and parameters that relations may drive."""

    model_config = STRICT

    program: Literal["creo"]
    title: str = Field(max_length=100, pattern=TITLE)
    file: str = Field(
        pattern=r"^[A-Za-z0-9_][A-Za-z0-9_-]{0,30}\.(prt|asm)$",
        description="file name of the model in Creo: `bearing.prt`",
    )
    length_unit: Literal["mm", "inch"] = Field(
        "mm", description="length unit of the model and of its mass properties"
    )
    parameters: list[Driven] = Field(min_length=1, max_length=100)

    @model_validator(mode="after")
    def names_are_distinct(self) -> Self:
        """Require distinct names.

        Raises
        ------
        ValueError
            If two entries have the same name.
        """
        names = [one.name for one in self.parameters]
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise ValueError(f"two parameters are called {', '.join(twice)}")
        return self

    def described(self, file: str, file_name: str) -> Description:
        """Return the description of the model; `file` is the hash of the manifest."""
        parameters = tuple(one.described() for one in self.parameters)
        return Description("creo", file, file_name, self.title.rstrip(". "), "Creo by CREOSON", parameters)


def read(content: bytes) -> Manifest:
    """Return a manifest from its JSON.

    Raises
    ------
    UnreadableModel
        If there are faults; the error lists all of them.
    """
    return read_manifest(Manifest, content, "the manifest for Creo")
